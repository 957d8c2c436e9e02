#pragma once

#include <span>
#include <string>

#include "downwash/base/checks.hpp"
#include "downwash/problems/problem_check.hpp"

namespace downwash {

/// What can be wrong with the goals of a problem beyond single values: unclear, too many, out of reach.
[[nodiscard]] std::span<const Check<ProblemCheck>> goal_checks();

/// "-90 to 90": the arm's limits in degrees. @pre it has some
[[nodiscard]] std::string arm_limits_text(const ArmParameters& arm);

}  // namespace downwash
