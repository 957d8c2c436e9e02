#pragma once

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/planner/braking.hpp"
#include "downwash/planner/goal_sequence.hpp"
#include "downwash/planner/worlds.hpp"

namespace downwash::planning {

/// Executes a plan with direct aerodynamics, from the start through all goals.
/// @param energy_budget_j as for execute()   @param wall_s set to how long that took [s]
/// @throws WorkStopped when it is over before the flight ends
[[nodiscard]] Execution execute_directly(const FlightModel& model, const FlightState& start, const Plan& plan,
                                         const std::vector<Goal>& goals, std::optional<double> energy_budget_j,
                                         double& wall_s, const StopCondition& is_over);

/// Whether a plan of MP-ARM-ADA counts after its direct flight: it reaches its goals and keeps the margin.
[[nodiscard]] DOWNWASH_EXPORT bool is_good(const Execution& flight, double safety_margin_m);

/// What plans of a search have to pass beside their own flight.
struct PlanChecks {
    ProblemWorlds* worlds = nullptr;  ///< that edges and plans have to survive; nullptr: everything is as believed
    StopFinder* stops = nullptr;      ///< says where a whole plan can be left for a hover; nullptr: nobody asks
};

/// MP-ARM-DA and MP-ARM-ADA: searches a flight to the goal of a problem without stops.
/// @param part the problem up to that goal   @param whole the problem that it is a part of, or itself
/// @param map of the planner's own model; nullptr for none   @param before what was flown up to the part's start
/// @return as PartSearch
DOWNWASH_EXPORT std::optional<std::size_t> search_flights(const Problem& part, const Problem& whole,
                                                          const FlightModel& model, const AeroMap* map,
                                                          const Course& before, const PlanChecks& checks,
                                                          const SolveOptions& options, Solution& solution);

}  // namespace downwash::planning
