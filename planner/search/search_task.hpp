#pragma once

#include <optional>

#include "downwash/problems/problem_model.hpp"
#include "downwash/search/fleet.hpp"
#include "downwash/search/search_space.hpp"

namespace downwash::planning {

/// What one search is about: a problem, the vehicle in its scene, what the planner knows of aerodynamics, and the whole
/// vehicle at the start. Immutable; problem, model and map must outlive it.
struct SearchTask {
    /// @param aero_map surface effects of the planner's own model; nullptr for none
    /// @param vehicle the whole vehicle at the start; empty: at the problem's start, with a controller at rest
    /// @param in_worlds must outlive it; nullptr: the nominal world is the only one
    /// @param tick_at_start control tick at the start, from that of the whole flight
    SearchTask(const Problem& the_problem, const FlightModel& flight_model, const AeroMap* aero_map,
               const std::optional<FlightState>& vehicle = {}, const SearchWorlds* in_worlds = nullptr,
               std::int64_t tick_at_start = 0)
        : problem(the_problem),
          model(flight_model),
          map(aero_map),
          start(vehicle ? *vehicle : start_state(flight_model, the_problem.start)),
          space(the_problem, flight_model),
          worlds(in_worlds),
          first_tick(tick_at_start) {}
    SearchTask(const SearchTask&) = delete;
    SearchTask& operator=(const SearchTask&) = delete;

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
    const AeroMap* map;
    FlightState start;
    SearchSpace space;
    const SearchWorlds* worlds;
    std::int64_t first_tick;  ///< see above
};

}  // namespace downwash::planning
