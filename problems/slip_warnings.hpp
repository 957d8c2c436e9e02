#pragma once

#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// Values of a robot that are likely in another unit: limits in radians, places and inertias that do not fit its size.
/// Keys are those of a robot file.
[[nodiscard]] std::vector<KeyError> robot_slips(const Robot& robot);
/// The same of a robot in space: limits in radians.
[[nodiscard]] std::vector<KeyError> robot_slips(const SpaceRobot& robot);

/// Values of a problem that are likely in another unit: angles in radians, an energy that no hover can do with.
[[nodiscard]] std::vector<KeyError> problem_slips(const Problem& problem);
/// The same of a problem in space, and what another value makes idle: a yaw beside an attitude, a tolerance about no
/// direction, a target that is another one once more.
[[nodiscard]] std::vector<KeyError> problem_slips(const SpaceProblem& problem);

}  // namespace downwash
