#pragma once

// Private: not installed. The parts of a problem that a page shows, in the coordinates of the plane of motion.

#include <nlohmann/json.hpp>

#include "downwash/problems/problem.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// Bounds and obstacles: the section of each with the plane, its projection on the plane, and its solid.
[[nodiscard]] nlohmann::ordered_json scene_json(const Problem& problem, const Scene& scene);

/// Bodies, rotors and arm, in the body frame.
[[nodiscard]] nlohmann::ordered_json robot_json(const Robot& robot);

/// All goals, and whether they are visited in turn or are alternatives.
[[nodiscard]] nlohmann::ordered_json goals_json(const Problem& problem);
[[nodiscard]] std::string_view goal_order(const Problem& problem);

/// The thrust ratio K of the first rotor over the bounds, in 255 steps from minimum to maximum.
[[nodiscard]] nlohmann::ordered_json map_json(const Problem& problem, const FlightModel& model, const AeroMap& map);

}  // namespace downwash
