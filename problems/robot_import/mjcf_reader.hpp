#pragma once

#include <filesystem>

#include "downwash/robot_import/kinematic_tree.hpp"
#include "downwash/robot_import/xml_element.hpp"

namespace downwash::robot_import {

/// Reads an MJCF model as MuJoCo compiles it. The robot is the body with a free joint, or the only one in the world.
/// Sites become links without mass. Actuators that push at sites are rotors, those of joints give their torques.
/// @param root of the same file, for places   @throws ProblemFileError
KinematicTree read_mjcf(const std::filesystem::path& file, const XmlElement& root, Findings& findings);

}  // namespace downwash::robot_import
