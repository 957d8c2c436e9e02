#pragma once

// Private: not installed. What a page shows of a problem, in the coordinates of the plane of motion.

#include <nlohmann/json.hpp>

#include "downwash/problems/problem.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// Bounds and obstacles: what of each is cut by the plane, its projection on the plane, and its solid.
[[nodiscard]] nlohmann::ordered_json scene_json(const Problem& problem, const Scene& scene);

/// Bodies, rotors and arm, in the body frame.
[[nodiscard]] nlohmann::ordered_json robot_json(const Robot& robot);

/// The goals one by one, and in which order they count.
[[nodiscard]] nlohmann::ordered_json goals_json(const Problem& problem);
[[nodiscard]] std::string_view goal_order(const Problem& problem);

/// The factor on the first rotor over the bounds, in 255 steps from the least to the greatest.
[[nodiscard]] nlohmann::ordered_json map_json(const Problem& problem, const FlightModel& model, const AeroMap& map);

}  // namespace downwash
