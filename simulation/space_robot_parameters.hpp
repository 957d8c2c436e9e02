#pragma once

#include <string_view>
#include <vector>

#include "downwash/base/checks.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/parameter_table.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash {

/// Every parameter of a robot in space with key, unit, default and range: the one table behind files, errors and
/// documentation.
[[nodiscard]] DOWNWASH_EXPORT const ParameterTable<SpaceRobot>& space_robot_parameters();

/// As space_robot_errors(), for a robot that is part of something larger and of which some values are already known to
/// be wrong or missing: neither they nor anything that depends on them is reported again.
/// @param prefix of the robot's keys, for example "robot."; the errors' keys begin with it too
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> further_space_robot_errors(const SpaceRobot& robot,
                                                                               WrongKeys& wrong,
                                                                               std::string_view prefix);

/// A planar robot with all that the conditions and checks of an uncertainty ask of one: rotor lag, delay, control rate
/// and whether rotors blow on the arm.
[[nodiscard]] DOWNWASH_EXPORT Robot uncertain_parts_of(const SpaceRobot& robot);

}  // namespace downwash
