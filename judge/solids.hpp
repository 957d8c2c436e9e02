#pragma once

#include <fcl/geometry/collision_geometry.h>
#include <fcl/math/bv/AABB.h>

#include <functional>
#include <memory>
#include <vector>

#include "downwash/scene/shapes.hpp"

// Solids and their distances by FCL. Private: not installed.

namespace downwash::judge {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;
using Pose = fcl::Transform3d;

/// A solid in a frame.
struct Part {
    Geometry geometry;
    Pose pose;
    fcl::AABBd box;  ///< in the same frame

    Part(Geometry shape, const Pose& at);
};

/// Hands out the solids that a shape consists of. @param pose of its frame
using TakeSolid = std::function<void(Geometry, const Pose&)>;
void read_shape(const Shape& shape, const Pose& pose, const TakeSolid& take);

/// A capsule along z, ready for queries. A rotor disc across z.
[[nodiscard]] Geometry capsule_of(double radius_m, double length_m);
[[nodiscard]] Geometry disc_of(double radius_m);

[[nodiscard]] Pose moved(const Eigen::Vector3d& by);

/// The distance of two solids [m], 0 on contact.
[[nodiscard]] double distance_between(const fcl::CollisionGeometryd& a, const Pose& at_a,
                                      const fcl::CollisionGeometryd& b, const Pose& at_b);

/// The solids of obstacles. Safe to share between threads.
class ObstacleSolids {
 public:
    explicit ObstacleSolids(const std::vector<Obstacle>& obstacles);
    ~ObstacleSolids();
    ObstacleSolids(const ObstacleSolids&) = delete;
    ObstacleSolids& operator=(const ObstacleSolids&) = delete;

    /// The least distance of a solid if it is below `enough_m`, else `enough_m`.
    [[nodiscard]] double distance_m(const Geometry& solid, const Pose& pose, double enough_m) const;

 private:
    struct Many;
    std::vector<Part> few_;       ///< meshes, and primitives if these are few
    std::unique_ptr<Many> many_;  ///< cubes of octrees, and primitives if these are many
};

}  // namespace downwash::judge
