#pragma once

// What scene/ knows about the placed obstacles beyond the public header. Private: not installed.

#include <string>
#include <vector>

#include "downwash/base/fault.hpp"
#include "downwash/scene/convex.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/seen_from_above.hpp"

namespace downwash {

/// Five lists of equal length, one entry per obstacle, in the world frame N.
struct Scene::Solids {
    std::vector<Obstacle> obstacles;
    std::vector<Placement> placements;  ///< rotation = Rz(yaw) Ry(pitch) Rx(roll)
    std::vector<Convex> convexes;
    std::vector<SeenFromAbove> seen_from_above;
    std::vector<Bounds> bounds;  ///< tight
};

/// Adds what is wrong with the sizes of a shape, under keys such as `key`.box.size_m.
void inspect(const Shape& shape, const std::string& key, std::vector<Fault>& faults);

}  // namespace downwash
