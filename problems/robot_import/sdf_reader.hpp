#pragma once

#include <filesystem>

#include "downwash/robot_import/kinematic_tree.hpp"

namespace downwash::robot_import {

/// Reads the first model of an SDF file with libsdformat, with models that it includes, and its rotors from plug-ins.
/// The base is a link "__model__" without mass, at the model's frame. @throws ProblemFileError
KinematicTree read_sdf(const std::filesystem::path& file, Findings& findings);

}  // namespace downwash::robot_import
