#pragma once

// Private to problems/.

#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/problems/problem_check.hpp"

namespace downwash {

/// What is likely not meant about meshes and octrees: what their files have that is passed over, surfaces that are
/// nearly closed or not at all, space of an octree that no sensor saw, and a unit, axis or place that leaves them where
/// the robot never gets. Part of problem_warnings().
[[nodiscard]] std::vector<KeyError> geometry_warnings(const ProblemCheck& check);

}  // namespace downwash
