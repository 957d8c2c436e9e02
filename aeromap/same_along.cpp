#include "downwash/aeromap/same_along.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <list>
#include <memory_resource>
#include <vector>

#include "downwash/aeromap/footprint.hpp"

namespace downwash {

SameAlong same_along(const DirectEffect& effect, const PlaneOfMotion& frame, const BoundingBox& hubs) {
    constexpr std::size_t max_parts = 64;  // more are hardly ever all level and in line
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (effect.settings().map || effect.is_of_walls() || effect.ground().depends_on_wall() ||
        effect.ceiling().depends_on_wall()) {
        return {};
    }
    const double r = effect.column_radius_m();
    std::array<std::byte, 4096> room;
    std::pmr::monotonic_buffer_resource memory(room.data(), room.size());
    std::pmr::vector<std::size_t> parts(&memory);
    effect.scene().add_parts_meeting(
        {{hubs.low_m[0] - r, hubs.low_m[1] - r, -infinity}, {hubs.high_m[0] + r, hubs.high_m[1] + r, infinity}}, parts);
    if (parts.size() > max_parts) {
        return {};
    }
    SameAlong same{true, true};
    std::list<Footprint> spare;
    const Footprints& footprints = effect.footprints();
    for (const std::size_t part : parts) {
        if (!effect.scene().has_shadow(part)) {
            continue;
        }
        const auto primitives = footprints.of_primitives();
        const Footprint& footprint = part < primitives.size() ? primitives[part] : footprints.of_other(part, spare);
        same.x = same.x && footprint.is_same_along(frame.cos_heading(), frame.sin_heading(), hubs, r);
        same.lateral = same.lateral && footprint.is_same_along(-frame.sin_heading(), frame.cos_heading(), hubs, r);
        if (!same.x && !same.lateral) {
            break;
        }
    }
    return same;
}

}  // namespace downwash
