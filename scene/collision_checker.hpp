#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/scene/collision_checker_kind.hpp"
#include "downwash/scene/planar_pose.hpp"
#include "downwash/scene/plane_of_motion.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// Answers whether and how near the robot touches the scene. Immutable; every query may run in several threads.
/// Bounding boxes dismiss what is plainly apart; between the others distances are enclosed to 1e-8 m
/// (scene/convex.hpp). Solids less than 1e-8 m apart are in contact, and so are a body inside a closed mesh and a pose
/// that is not finite. No query allocates.
///
/// With FCL, clearances are good to a millimetre and contact to about 1e-6 m, and queries may allocate. FCL's objects
/// are made at the first query.
/// @pre angles of at most 1e5 rad
class DOWNWASH_EXPORT CollisionChecker {
 public:
    /// @throws InputError when a body or the arm has a size that is not finite and positive; keys as in RobotShape
    CollisionChecker(std::shared_ptr<const Scene> scene, const PlaneOfMotion& plane, const RobotShape& robot,
                     CollisionCheckerKind kind = CollisionCheckerKind::own);

    /// Who answers.
    [[nodiscard]] CollisionCheckerKind kind() const noexcept;

    /// Whether a body of the robot is nearer than `margin_m` (>= 0) to an obstacle, or touches it. Every such pose is
    /// found; a pose up to 1e-8 m farther away may be reported too.
    [[nodiscard]] bool is_nearer_than(const PlanarPose& pose, double margin_m) const;

    /// No point of the multirotor's bodies is farther from its centre of mass [m].
    [[nodiscard]] double body_reach_m() const noexcept;

    /// No point of the robot is farther from the multirotor's centre of mass at any arm angle [m].
    [[nodiscard]] double robot_reach_m() const noexcept;

    /// Smallest distance from the robot to any obstacle [m]; <= 0 on contact, infinity without obstacles.
    [[nodiscard]] double clearance_m(const PlanarPose& pose) const;

    /// The number in Scene::obstacles() of the obstacle nearest to the robot, if it is nearer than `within_m`. Of
    /// several in contact, any. Computed by our own geometry, whatever the kind.
    [[nodiscard]] std::optional<std::size_t> nearest_obstacle(const PlanarPose& pose, double within_m) const;

 private:
    struct Impl;
    std::shared_ptr<const Impl> impl_;
};

/// Euclidean distance from a level disc to the nearest obstacle [m]; 0 on contact and inside closed meshes, infinity
/// without obstacles.
/// This decides the flyable area (thesis figure 5.4).
[[nodiscard]] DOWNWASH_EXPORT double disc_clearance_m(const Scene& scene, const Vector3& center_m, double radius_m);

/// True if the level disc keeps at least `distance_m` (>= 0) from every obstacle and touches none. Agrees with
/// disc_clearance_m, but is faster.
[[nodiscard]] DOWNWASH_EXPORT bool disc_is_clear(const Scene& scene, const Vector3& center_m, double radius_m,
                                                 double distance_m);

/// True if no obstacle reaches into the upright cylinder of a height (>= 0) on the level disc. Never true if one does;
/// false is certain but for some 1e-6 m.
[[nodiscard]] DOWNWASH_EXPORT bool column_is_clear(const Scene& scene, const Vector3& center_m, double radius_m,
                                                   double height_m);

/// Distance from a point to the nearest obstacle within the horizontal plane through the point [m]: to walls, not to
/// ground and ceiling. 0 inside an obstacle, infinity if the plane cuts none. Never above the truth but for
/// rounding, and below it by at most 1e-8 m before a wall, 1e-6 m before a slope of one in a hundred; where the plane
/// grazes a round solid by up to a hundredth of its radius.
[[nodiscard]] DOWNWASH_EXPORT double horizontal_clearance_m(const Scene& scene, const Vector3& point_m);

}  // namespace downwash
