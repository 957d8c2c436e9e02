#include "downwash/search/obstacle_labels.hpp"

namespace downwash::planning {

std::map<std::string, std::uint64_t> labelled(const StoppedBy& counts, const Scene& scene) {
    std::map<std::string, std::uint64_t> by_label;
    for (const auto& [obstacle, count] : counts) {
        by_label[label_of(scene.obstacles(), obstacle)] += count;
    }
    return by_label;
}

}  // namespace downwash::planning
