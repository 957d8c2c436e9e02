#pragma once

#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/report/picture.hpp"
#include "downwash/scene/plane_of_motion.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/scene/space_shape.hpp"

namespace downwash {

/// The drawing of an obstacle in a vertical plane.
struct ObstacleOutline {
    std::string name;
    bool is_cut = true;  ///< whether the plane cuts it; otherwise its projection on the plane is shown
    /// Closed rings. Those of a mesh with cavities run around solid parts in one sense and around holes in the other.
    std::vector<Ring> rings;
    /// Open lines, where the plane cuts a surface that is not closed.
    std::vector<Ring> lines;
    /// Convex hulls of the projected parts of a mesh that the plane does not cut, where it cuts others. Empty for a
    /// mesh with more parts or triangles than can be told apart in a picture.
    std::vector<Ring> beside = {};
};

/// Every obstacle of the scene in the plane parallel to the plane of motion, `lateral_m` to the left of it: the cross
/// section of those that it cuts, the convex hull of the projection of the others. Round shapes become inscribed
/// polygons of 96 sides.
[[nodiscard]] DOWNWASH_EXPORT std::vector<ObstacleOutline> obstacle_outlines(const Scene& scene,
                                                                             const PlaneOfMotion& plane,
                                                                             double lateral_m);

/// The projection of every obstacle on the plane of motion, whether it is cut or not.
[[nodiscard]] DOWNWASH_EXPORT std::vector<ObstacleOutline> projected_outlines(const Scene& scene,
                                                                              const PlaneOfMotion& plane);

/// From the axes of the world to those of a picture: across, away from the viewer, and up. A rotation.
inline constexpr Matrix3 seen_from_above{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};      ///< x across, y up
inline constexpr Matrix3 seen_from_the_side{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};    ///< x across, z up
inline constexpr Matrix3 seen_from_the_front{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};  ///< y across, z up

/// Every obstacle as it is seen from far away, as if all of it were cut: a convex ring, or one for each part of a mesh
/// that consists of parts.
[[nodiscard]] DOWNWASH_EXPORT std::vector<ObstacleOutline> seen_outlines(const Scene& scene, const Matrix3& view);

/// A solid of a robot as it is seen from far away: a convex ring.
/// @param rotation from the axes of its body to those of the world   @param origin_m of its body in the world
[[nodiscard]] DOWNWASH_EXPORT Ring seen_outline(const SpaceBodyShape& solid, const Matrix3& rotation,
                                                const Vector3& origin_m, const Matrix3& view);

/// The side view of a robot's bodies: one convex ring each, in the body frame.
[[nodiscard]] DOWNWASH_EXPORT std::vector<Ring> body_outlines(const std::vector<BodyShape>& bodies);

}  // namespace downwash
