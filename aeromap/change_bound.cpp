#include "downwash/aeromap/change_bound.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory_resource>
#include <vector>

#include "downwash/base/infinity.hpp"

namespace downwash {
namespace {}  // namespace

SidedChange max_change(const DirectEffect& effect, const BoundingBox& hubs) {
    if (effect.settings().map || effect.is_of_walls()) {
        return {0, infinity};
    }
    const Scene& scene = effect.scene();
    const double r = effect.column_radius_m();
    const BoundingBox column{{hubs.low_m[0] - r, hubs.low_m[1] - r, -infinity},
                             {hubs.high_m[0] + r, hubs.high_m[1] + r, infinity}};
    double below_m = infinity;
    double above_m = infinity;
    std::array<std::byte, 4096> room;
    std::pmr::monotonic_buffer_resource memory(room.data(), room.size());
    std::pmr::vector<std::size_t> parts(&memory);
    scene.add_parts_meeting(column, parts);
    for (const std::size_t part : parts) {
        const BoundingBox bounds = scene.part_bounds(part);
        if (bounds.low_m[2] <= hubs.high_m[2]) {
            below_m = std::min(below_m, std::max(0.0, hubs.low_m[2] - bounds.high_m[2]));
        }
        if (bounds.high_m[2] >= hubs.low_m[2]) {
            above_m = std::min(above_m, std::max(0.0, bounds.low_m[2] - hubs.high_m[2]));
        }
    }
    const double unit_m = effect.rotor_radius_m();
    return {effect.largest_change_from_below(below_m / unit_m), effect.largest_change_from_above(above_m / unit_m)};
}

bool is_quiet(const DirectEffect& effect, const SidedChange& change) {
    constexpr double quiet_change = 0.006;
    return !effect.settings().enabled || change.below + change.above <= quiet_change;
}

CellSides sides_of(const SidedChange& change) {
    return change.above <= quiet_side   ? CellSides::below
           : change.below <= quiet_side ? CellSides::above
                                        : CellSides::both;
}

}  // namespace downwash
