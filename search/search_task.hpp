#pragma once

#include <optional>

#include "downwash/problems/problem_model.hpp"
#include "downwash/search/search_space.hpp"

namespace downwash::planning {

/// What one search is about: a problem, the vehicle in its scene, what the planner knows of aerodynamics, and the whole
/// vehicle at the start. Immutable; problem, model and map must outlive it.
struct SearchTask {
    /// @param aero_map surface effects of the planner's own model; nullptr for none
    /// @param vehicle the whole vehicle at the start; empty: at the problem's start, with a controller at rest
    SearchTask(const Problem& the_problem, const FlightModel& flight_model, const AeroMap* aero_map,
               const std::optional<FlightState>& vehicle = {})
        : problem(the_problem),
          model(flight_model),
          map(aero_map),
          start(vehicle ? *vehicle : start_state(flight_model, the_problem.start)),
          space(the_problem, flight_model) {}
    SearchTask(const SearchTask&) = delete;
    SearchTask& operator=(const SearchTask&) = delete;

    const Problem& problem;
    const FlightModel& model;
    const AeroMap* map;
    FlightState start;
    SearchSpace space;
};

}  // namespace downwash::planning
