#pragma once

#include <optional>

#include "downwash/problems/problem_model.hpp"
#include "downwash/search/fleet.hpp"
#include "downwash/search/search_space.hpp"
#include "downwash/search/space_search_space.hpp"

namespace downwash::planning {

/// A plan for a vehicle, without knots.
[[nodiscard]] inline Plan blank_plan_of(const FlightModel& model) {
    return {{}, model.tick().tick_s};
}
[[nodiscard]] inline SpacePlan blank_plan_of(const SpaceProblemModel& model) {
    const SpaceRobot& robot = model.problem().robot;
    return {{}, 1 / robot.controller.rate_hz, robot.joints()};
}

/// What one search is about: a problem, the vehicle in its scene, what the planner knows of aerodynamics, and the whole
/// vehicle at the start. Immutable; problem, model and map must outlive it.
template <class Family>
struct SearchTaskOf {
    using FlightState = typename Family::FlightState;
    using SearchSpace = typename Family::SearchSpace;
    using Problem = typename Family::Problem;
    using Effects = typename Family::Effects;
    using Plan = typename Family::Plan;
    using FlightModel = typename Family::FlightModel;
    using Fleet = FleetOf<Family>;
    using SearchWorlds = SearchWorldsOf<Family>;

    /// @param aero_map surface effects of the planner's own model; nullptr for none
    /// @param vehicle the whole vehicle at the start; empty: at the problem's start, with a controller at rest
    /// @param in_worlds must outlive it; nullptr: the nominal world is the only one
    /// @param tick_at_start control tick at the start, from that of the whole flight
    SearchTaskOf(const Problem& the_problem, const FlightModel& flight_model, const Effects* aero_map,
                 const std::optional<FlightState>& vehicle = {}, const SearchWorlds* in_worlds = nullptr,
                 std::int64_t tick_at_start = 0)
        : problem(the_problem),
          model(flight_model),
          map(aero_map),
          start(vehicle ? *vehicle : start_state(flight_model, the_problem.start)),
          space(the_problem, flight_model),
          blank_plan(blank_plan_of(flight_model)),
          tick_s(blank_plan.tick_s),
          worlds(in_worlds),
          first_tick(tick_at_start) {}
    SearchTaskOf(const SearchTaskOf&) = delete;
    SearchTaskOf& operator=(const SearchTaskOf&) = delete;

    /// The vehicle at the start in every world.
    [[nodiscard]] Fleet fleet_from(const FlightState& nominal) const {
        Fleet fleet{nominal};
        if (worlds != nullptr) {
            fleet.insert(fleet.end(), worlds->start.begin(), worlds->start.end());
        }
        return fleet;
    }

    /// Whether edges are flights; those of MP-ARM are lines.
    [[nodiscard]] bool flies() const noexcept { return plans_flights(problem.planner.variant); }

    const Problem& problem;
    const FlightModel& model;
    const Effects* map;
    FlightState start;
    SearchSpace space;
    Plan blank_plan;  ///< one without knots
    double tick_s;    ///< control period [s]
    const SearchWorlds* worlds;
    std::int64_t first_tick;  ///< see above
};
using SearchTask = SearchTaskOf<Plane>;

}  // namespace downwash::planning
