#pragma once

// Private to scene/: solids and triangles as FCL takes them.

#include <fcl/geometry/collision_geometry.h>
#include <fcl/math/bv/AABB.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/scene/space_shape.hpp"
#include "downwash/scene/triangle.hpp"

namespace downwash::in_fcl {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;
using Pose = fcl::Transform3d;

[[nodiscard]] inline Eigen::Vector3d vector_of(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

[[nodiscard]] Pose pose_of(const Matrix3& rotation, const Vector3& at_m);

/// FCL's shape of a solid whose own frame has that pose, and where FCL's frame is.
[[nodiscard]] std::pair<Geometry, Pose> placed_solid(const SpaceShape& shape, const Pose& pose);

/// Half the extent of a convex solid along a direction in its own frame [m]; infinity where the shape is none of ours.
[[nodiscard]] double half_extent_m(const fcl::CollisionGeometryd& shape, const Eigen::Vector3d& d);

/// The box along the axes of the world around a convex solid. @param at its pose
[[nodiscard]] fcl::AABBd box_around(const fcl::CollisionGeometryd& shape, const Pose& at);

/// Some triangles of a scene.
struct Triangles {
    const std::vector<Triangle>* all;  ///< that the scene keeps
    std::vector<std::uint32_t> which;

    /// Calls use(triangle) for each.
    template <class Use>
    void each(const Use& use) const {
        std::for_each(which.begin(), which.end(), [&](std::uint32_t i) { use((*all)[i]); });
    }
};

/// FCL's tree over triangles.
[[nodiscard]] Geometry tree_of(const Triangles& triangles);

[[nodiscard]] fcl::AABBd box_around(const Triangles& triangles);

}  // namespace downwash::in_fcl
