#pragma once

// What scene/ knows about the placed obstacles beyond the public header. Private: not installed.

#include <vector>

#include "downwash/scene/scene.hpp"

namespace downwash {

/// How an obstacle stands in the world frame N.
struct Placement {
    Matrix3 rotation{};    ///< local frame to N: Rz(yaw) Ry(pitch) Rx(roll); its columns are the local axes in N
    Vector3 axis_world{};  ///< unit axis in N of a cylinder; the local z axis of other shapes
};

/// Three lists of equal length, one entry per obstacle. Plain data: the checkers build what their library needs.
struct Scene::Solids {
    std::vector<Obstacle> obstacles;
    std::vector<Placement> placements;
    std::vector<Bounds> bounds;  ///< tight
};

}  // namespace downwash
