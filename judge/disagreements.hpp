#pragma once

#include <string>
#include <variant>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/judge/plan_judge.hpp"
#include "downwash/results/claims.hpp"

namespace downwash::judge {

/// Something in a solution file that is not as the judge finds it.
struct Disagreement {
    /// A figure or a name.
    using Value = std::variant<double, std::string>;
    std::string what;   ///< a key of the file, "execution.cost", or a part of the plan, "plan.reference[3] speed_m_s"
    Value file, judge;  ///< what the file says; what the judge finds, or the limit that the file breaks
};

/// How far the file's flight and the judge's may be apart.
inline constexpr double clearance_tolerance_m = 0.01;
inline constexpr double goal_error_tolerance_m = 0.01;
inline constexpr double cost_tolerance = 0.01;    ///< relative; of energy, too
inline constexpr double limit_tolerance = 0.005;  ///< relative; the planner keeps the motion limits to 0.3 %

/// What is wrong with the plan itself: waypoints that are not where the reference is, another start than the problem's,
/// speeds or accelerations beyond the motion limits, an end that moves or is not in the goal.
[[nodiscard]] DOWNWASH_EXPORT std::vector<Disagreement> disagreements_in_plan(const Claims& claims,
                                                                              const Problem& problem);

/// What the file says about its flight otherwise than the judge, who flew under the same conditions.
[[nodiscard]] DOWNWASH_EXPORT std::vector<Disagreement> disagreements_about_flight(const FlightClaims& claims,
                                                                                   const CostFunction& objective,
                                                                                   const JudgedFlight& flight,
                                                                                   double tick_s);

}  // namespace downwash::judge
