#pragma once

#include <string>

#include "downwash/robot_import/robot_builder.hpp"

namespace downwash::robot_import {

/// A robot file with the controller of the robot. Comments say where numbers come from and what was assumed.
/// @param from the file and its format, for the first comment
std::string robot_text(const BuiltRobot& built, const std::string& from);

}  // namespace downwash::robot_import
