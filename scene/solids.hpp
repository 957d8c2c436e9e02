#pragma once

// What scene/ knows about the placed obstacles beyond the public header. Private: not installed.

#include <optional>
#include <string>
#include <vector>

#include "downwash/base/fault.hpp"
#include "downwash/scene/convex.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/seen_from_above.hpp"

namespace downwash {

/// Six lists of equal length, one entry per obstacle, in the world frame N.
struct Scene::Solids {
    std::vector<Obstacle> obstacles;
    std::vector<Primitive> primitives;
    std::vector<Placement> placements;  ///< rotation = Rz(yaw) Ry(pitch) Rx(roll)
    std::vector<Convex> convexes;
    std::vector<SeenFromAbove> seen_from_above;
    std::vector<Bounds> bounds;  ///< tight
};

/// Adds what is wrong with the sizes of a shape, under keys such as `key`.box.size_m.
void inspect(const Primitive& shape, const std::string& key, std::vector<Fault>& faults);

/// The primitive that a shape is, if it is one.
std::optional<Primitive> primitive_of(const Shape& shape);

}  // namespace downwash
