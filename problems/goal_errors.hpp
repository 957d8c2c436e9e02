#pragma once

#include <span>

#include "downwash/base/checks.hpp"
#include "downwash/problems/problem_check.hpp"

namespace downwash {

/// What can be wrong with the goals of a problem beyond single values: unclear, too many, out of reach.
[[nodiscard]] std::span<const Check<ProblemCheck>> goal_checks();

}  // namespace downwash
