#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/space_bounds.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// Whether a ball gets from one point to some others among obstacles.
struct BallWay {
    bool is_parted = false;              ///< proven: its centre gets to none of them
    std::vector<std::size_t> obstacles;  ///< when parted: those around what it reaches, by number, in rising order
};

/// Looks for ways of a ball on cubes of 0.7 of its radius, which a path can only pass if the middle of each is at least
/// 0.39 radii from every obstacle: a wall of any thickness parts them. So a way that exists is found, and what is
/// parted has none; but a narrow passage may count as a way without being one.
/// @param bounds of its centre   @param radius_m of the ball, > 0   @param from_m,to_m centres within the bounds
/// @param max_cubes looked at before it gives up: then nothing
[[nodiscard]] DOWNWASH_EXPORT std::optional<BallWay> way_of_ball(const std::shared_ptr<const Scene>& scene,
                                                                 const SpaceBounds& bounds, double radius_m,
                                                                 const Vector3& from_m, std::span<const Vector3> to_m,
                                                                 std::size_t max_cubes = 1'000'000);

}  // namespace downwash
