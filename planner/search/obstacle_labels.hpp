#pragma once

// What messages and results call obstacles, and which of them stop edges. Private: not installed.

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "downwash/search/search_record.hpp"
#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/flight_rules.hpp"

namespace downwash::planning {

/// Counts the obstacle that a robot touches or comes nearer to than a margin; none where a flight touched one between
/// two ticks and has left it.
template <class Model, class Pose>
void count_collision(const Model& model, const Pose& pose, double margin_m, StoppedBy& counts) {
    const double within_m = margin_m + max_unseen_motion_m(margin_m);
    if (const std::optional<std::size_t> obstacle = model.collisions().nearest_obstacle(pose, within_m)) {
        ++counts[*obstacle];
    }
}

/// The label of the obstacle nearest to a robot; empty without obstacles.
template <class Model, class Pose>
[[nodiscard]] std::vector<std::string> obstacles_near(const Model& model, const Pose& pose) {
    const auto obstacle = model.collisions().nearest_obstacle(pose, std::numeric_limits<double>::infinity());
    return obstacle ? std::vector{label_of(model.scene().obstacles(), *obstacle)} : std::vector<std::string>();
}

/// Counts by the labels of the obstacles.
[[nodiscard]] std::map<std::string, std::uint64_t> labelled(const StoppedBy& counts, const Scene& scene);

}  // namespace downwash::planning
