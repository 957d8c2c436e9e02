#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash::planning {

/// What lies before a search for the way to one of several goals: the flight to those before it. Empty for the first.
struct Course {
    std::vector<Goal> goals;     ///< reached and held
    Plan plan;                   ///< through them, to the end of the last hold
    std::uint64_t attempts = 0;  ///< plans that asked for a certificate on the way
    FlightState vehicle;         ///< the whole vehicle there, as the planner's own model flies it
    double cost = 0;

    /// The course before the first goal.
    [[nodiscard]] DOWNWASH_EXPORT static Course from_start(const Problem& problem, const FlightModel& model);

    /// The course and a plan that begins where it ends, as one plan.
    [[nodiscard]] Plan continued_by(const Plan& next) const;
};

/// Adds a part's plan and the hold at its end to a course, and flies them in the planner's model.
/// @param cost of the part, hold included   @param plans_flights what was planned by flights flies as it did; of
/// MP-ARM's plans nobody has to know where the vehicle gets to, as none of them looks at it
[[nodiscard]] Course advanced(Course course, const Goal& goal, const Plan& part, double cost, const FlightModel& model,
                              const AeroMap* map, bool plans_flights);

/// Searches for the way to the goal of a problem without stops, whose start is at the end of the course before. Fills
/// what it finds, and how that went, into the solution: cost and plan from there on, and, where it was flown with
/// direct aerodynamics, the execution of course and plan together.
/// @return the goal before, from 0, the way to which has to be searched anew: its flights fail most often in the worlds
/// of certificates, so that no way from there helps. Empty otherwise
using PartSearch = std::function<std::optional<std::size_t>(const Problem& part, const SolveOptions&,
                                                            const Course& before, Solution&)>;

/// Searches goal by goal, each from the whole vehicle that holds at the one before: in a first round until there is a
/// whole way, then in rounds that take twice as long each, for cheaper ways. Where the flights of a plan fail on the
/// way to an earlier goal, the search goes back to that goal. More of a round's time goes to the parts that became
/// cheaper in the one before. The order is kept, and every part is found by itself: the whole is not the best of all
/// ways through the goals. If no round finds a whole way, what there is of one is `approximate`.
/// @param map of the planner's own model; nullptr for none
/// @param least_round share of the limits that a round after the first takes at least
/// @param attempts plans that asked for a certificate before, and then with those of this search
DOWNWASH_EXPORT void solve_in_turn(const Problem& problem, const FlightModel& model, const AeroMap* map,
                                   const SolveOptions& options, const PartSearch& search, double least_round,
                                   std::uint64_t& attempts, Solution& solution);

}  // namespace downwash::planning
