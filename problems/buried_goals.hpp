#pragma once

// Private to problems/.

#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// Goals so deep inside a box, cylinder or sphere that the robot cannot be at them without touching it, whatever the
/// yaw and the joints, or that no camera can see. It is proven: other obstacles and goals near a surface are left to
/// space_goal_warnings(). Of alternatives all are.
/// @pre sizes of obstacles and values of goals are sound
[[nodiscard]] std::vector<KeyError> buried_goals(const SpaceProblem& problem);

}  // namespace downwash
