#pragma once

// Private: not installed. The parts of a problem that a page shows, in the coordinates of the plane of motion.

#include <nlohmann/json_fwd.hpp>

#include <optional>

#include "downwash/problems/visit_order.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// Adds to a page: description, scene, robot, start, goals, limits, and the thrust ratio where surfaces act on rotors.
/// @param model of the problem   @param threads at least 1; the page does not depend on it
void add_problem(nlohmann::ordered_json& page, const Problem& problem, const std::optional<VisitOrder>& order,
                 const FlightModel& model, int threads);

}  // namespace downwash
