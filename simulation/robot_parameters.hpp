#pragma once

#include <string_view>
#include <vector>

#include "downwash/base/checks.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/parameter_table.hpp"
#include "downwash/simulation/robot.hpp"

namespace downwash {

/// Every parameter of a robot with key, unit, default and range: the one table behind files, faults and documentation.
[[nodiscard]] DOWNWASH_EXPORT const ParameterTable<Robot>& robot_parameters();

/// As robot_faults, for a robot that is part of something larger and of which some values are already known to be wrong
/// or missing: neither they nor anything that depends on them is reported again.
/// @param prefix of the robot's keys, for example "robot."; the faults' keys begin with it too
[[nodiscard]] DOWNWASH_EXPORT std::vector<Fault> further_robot_faults(const Robot& robot, FaultyKeys& faulty,
                                                                      std::string_view prefix);

}  // namespace downwash
