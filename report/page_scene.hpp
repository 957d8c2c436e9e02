#pragma once

// Private: not installed. The parts of a problem that a page shows, in the coordinates of the plane of motion.

#include <nlohmann/json.hpp>

#include "downwash/problems/problem.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// Adds to a page: description, scene, robot, start, goals, limits and aero map.
/// @param model of the problem   @param map of the problem; nullptr: none
void add_problem(nlohmann::ordered_json& page, const Problem& problem, const FlightModel& model, const AeroMap* map);

}  // namespace downwash
