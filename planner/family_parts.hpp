#pragma once

#include <optional>
#include <vector>

#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/direct_flight.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/planner/world_flights.hpp"
#include "downwash/problems/objective.hpp"
#include "downwash/search/search_task.hpp"

// What the planner asks of problems, plans and flights of both families.

namespace downwash::planning {

/// A problem with a single goal and nothing else to do, from where a plan before ends; without knots, from its own
/// start.
[[nodiscard]] Problem part_of(const Problem& problem, const Goal& goal, const Plan& before);
[[nodiscard]] SpaceProblem part_of(const SpaceProblem& problem, const SpaceGoal& goal, const SpacePlan& before);

/// The goal of a problem that has one.
[[nodiscard]] inline const Goal& goal_of(const Problem& part) noexcept {
    return part.goal;
}
[[nodiscard]] inline const SpaceGoal& goal_of(const SpaceProblem& part) noexcept {
    return part.goals.front();
}

/// A vehicle that rests at a configuration.
[[nodiscard]] inline Start start_at(const Problem& /*problem*/, const Configuration& at) {
    return Start::resting_at(at);
}
[[nodiscard]] SpaceStart start_at(const SpaceProblem& problem, const SpaceConfiguration& at);

/// Where a plan ends. @pre there is a knot
[[nodiscard]] inline Configuration end_of(const Plan& plan) {
    return plan.last();
}
[[nodiscard]] inline SpaceConfiguration end_of(const SpacePlan& plan) {
    return configuration_of(plan.reference.back().point);
}

/// A plan and the hover at its last goal, which ends at a knot of its own.
[[nodiscard]] SpacePlan with_hover(const SpacePlan& plan, const SpaceGoal& goal, const SpaceProblemModel& model);

/// The vehicle at the end of a plan that is flown on from one of its knots to a goal, in the planner's own model. A
/// touch that follows is flown, too; one that is not met in this model leaves the vehicle before it.
/// @param first the knot at which the vehicle is   @throws std::logic_error if the flight is rejected
[[nodiscard]] FlightState flown_on(const PlannerModel& model, const Plan& plan, std::size_t first, const Goal& goal,
                                   FlightState vehicle);
[[nodiscard]] AnySpaceState flown_on(const PlannerModelOf<Space>& model, const SpacePlan& plan, std::size_t first,
                                     const SpaceGoal& goal, const AnySpaceState& vehicle);

/// Flies the touch that follows a hover in space in a planner's model. @throws WorkStopped
/// @param map nullptr: surfaces do not act   @param at reference of the hover   @param world nullptr: the nominal one
/// @param[in,out] vehicle
[[nodiscard]] SpaceTouchFlown fly_touch(const SpaceProblemModel& model, const SurfaceVolumes* map,
                                        const SpaceGoalRule& rule, const SpaceGoalHover& hover, const SpacePoint& at,
                                        const SpaceWorld* world, std::int64_t first_tick, AnySpaceState& vehicle,
                                        const StopCondition& is_over = {});

/// Executes a plan in space with direct aerodynamics; see fly_directly() of the plane.
/// @param start of which the controller's memory does not count   @param energy_budget_j that of the problem
[[nodiscard]] DirectFlightOf<Space> fly_directly(const SpaceProblemModel& model, const AnySpaceState& start,
                                                 const SpacePlan& plan, const std::vector<SpaceGoal>& goals,
                                                 std::optional<double> energy_budget_j, const StopCondition& is_over);

/// Whether a plan counts after its direct flight.
[[nodiscard]] bool is_good(const SpaceFlight& flight, double safety_margin_m);

/// What an executed flight costs.
[[nodiscard]] double cost_when_executed(const Execution& flight, const CostFunction& objective);
[[nodiscard]] double cost_when_executed(const SpaceFlight& flight, const CostFunction& objective);

/// What a plan costs when it is executed or, as long as it was not, by the planner's own figure.
template <class AnyFound>
[[nodiscard]] double cost_when_flown(const AnyFound& found, const CostFunction& objective) {
    return found.execution ? cost_when_executed(*found.execution, objective) : found.cost;
}

/// Where a direct flight that does not count came nearest to an obstacle or, if that is not why, where it ended.
[[nodiscard]] Obstruction obstruction_of(const Execution& flight, const SearchTask& task);
[[nodiscard]] SpaceObstruction obstruction_of(const SpaceFlight& flight, const SearchTaskOf<Space>& task);

}  // namespace downwash::planning
