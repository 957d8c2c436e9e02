#include "downwash/search/obstacle_labels.hpp"

#include <limits>
#include <optional>

#include "downwash/simulation/flight_rules.hpp"

namespace downwash::planning {

void count_collision(const FlightModel& model, const PlanarPose& pose, double margin_m, StoppedBy& counts) {
    const double within_m = margin_m + max_unseen_motion_m(margin_m);
    if (const std::optional<std::size_t> obstacle = model.collisions().nearest_obstacle(pose, within_m)) {
        ++counts[*obstacle];
    }
}

std::vector<std::string> obstacles_near(const FlightModel& model, const PlanarPose& pose) {
    const auto obstacle = model.collisions().nearest_obstacle(pose, std::numeric_limits<double>::infinity());
    return obstacle ? std::vector{label_of(model.scene().obstacles(), *obstacle)} : std::vector<std::string>();
}

std::map<std::string, std::uint64_t> labelled(const StoppedBy& counts, const Scene& scene) {
    std::map<std::string, std::uint64_t> by_label;
    for (const auto& [obstacle, count] : counts) {
        by_label[label_of(scene.obstacles(), obstacle)] += count;
    }
    return by_label;
}

}  // namespace downwash::planning
