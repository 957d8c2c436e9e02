#pragma once

#include <filesystem>
#include <string>

#include "downwash/robot_import/kinematic_tree.hpp"
#include "downwash/robot_import/xml_element.hpp"

namespace downwash::robot_import {

/// Reads a URDF with liburdfdom, and its rotors from plug-ins of Gazebo.
/// @param root of the same text   @throws ProblemFileError
KinematicTree read_urdf(const std::filesystem::path& file, const std::string& text, const XmlElement& root,
                        Findings& findings);

}  // namespace downwash::robot_import
