#pragma once

// What messages and results call obstacles, and which of them stop edges. Private: not installed.

#include <map>
#include <string>
#include <vector>

#include "downwash/scene/planar_pose.hpp"
#include "downwash/search/search_record.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::planning {

/// Counts the obstacle that a robot touches or comes nearer to than a margin; none where a flight touched one between
/// two ticks and has left it.
void count_collision(const FlightModel& model, const PlanarPose& pose, double margin_m, StoppedBy& counts);

/// The label of the obstacle nearest to a robot; empty without obstacles.
[[nodiscard]] std::vector<std::string> obstacles_near(const FlightModel& model, const PlanarPose& pose);

/// Counts by the labels of the obstacles.
[[nodiscard]] std::map<std::string, std::uint64_t> labelled(const StoppedBy& counts, const Scene& scene);

}  // namespace downwash::planning
