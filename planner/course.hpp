#pragma once

#include <cstdint>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash::planning {

/// The flight that leads to the start of a search for the way to one of several goals. Empty for the first goal.
template <class Family>
struct CourseOf {
    using Plan = typename Family::Plan;
    using FlightState = typename Family::FlightState;
    using Problem = typename Family::Problem;
    using Goal = typename Family::Goal;
    using FlightModel = typename Family::FlightModel;

    std::vector<Goal> goals;     ///< reached and held
    Plan plan;                   ///< through them, to the end of the last hold
    std::uint64_t attempts = 0;  ///< plans that asked for a certificate on the way
    FlightState vehicle;         ///< the whole vehicle there, as the planner's own model flies it
    double cost = 0;

    /// The course before the first goal.
    [[nodiscard]] DOWNWASH_EXPORT static CourseOf from_start(const Problem& problem, const FlightModel& model);

    /// Ticks from the start of the flight.
    [[nodiscard]] std::int64_t ticks() const { return plan.reference.empty() ? 0 : plan.reference.back().tick; }
};
using Course = CourseOf<Plane>;

/// Adds a part's plan and the hold at its end to a course, and flies them in the planner's model.
/// @param cost of the part, hold included   @param variant that planned the part
template <class Family>
[[nodiscard]] CourseOf<Family> advanced(CourseOf<Family> course, const typename Family::Goal& goal,
                                        const typename Family::Plan& part, double cost,
                                        const PlannerModelOf<Family>& model, Variant variant);

}  // namespace downwash::planning
