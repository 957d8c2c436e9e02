#pragma once

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/judge/disagreements.hpp"
#include "downwash/judge/space_judged_flight.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/results/claims.hpp"

// What of a solution file in space is not as the judge finds it; disagreements.hpp has the tolerances.

namespace downwash::judge {

/// The greatest error of all goals of a flight [m].
[[nodiscard]] DOWNWASH_EXPORT double worst_goal_error_m(const SpaceJudgedFlight& flight) noexcept;

/// What is wrong with the plan itself: waypoints that are not where the reference is, another start than the problem's,
/// speeds or accelerations beyond the motion limits, an end that moves.
[[nodiscard]] DOWNWASH_EXPORT std::vector<Disagreement> disagreements_in_plan(const SpaceClaims& claims,
                                                                              const SpaceProblem& problem);

/// What the file says about its flight otherwise than the judge, who flew under the same conditions. The cost is
/// compared where the file has one, and only for objectives of energy and time.
[[nodiscard]] DOWNWASH_EXPORT std::vector<Disagreement> disagreements_about_flight(const SpaceClaims& claims,
                                                                                   const SpaceJudgedFlight& flight);

}  // namespace downwash::judge
