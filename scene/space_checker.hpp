#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/scene/collision_checker_kind.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/space_motion.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/scene/space_robot_shape.hpp"

namespace downwash {

/// Answers whether and how near a robot in space touches the scene, or itself. Immutable; every query may run in
/// several threads. Distances, contact and FCL are as of CollisionChecker: exact to 1e-8 m by our own geometry, which
/// never allocates; good to a millimetre, contact to about 1e-6 m, by FCL.
///
/// A robot touches itself if solids of two different bodies touch. Neighbours are not compared: a link and what it is
/// mounted on, where links without a solid count as part of what they are mounted on. Solids that touch at whatever
/// joint angles are not compared either: they overlap by design. While all joints are within their limits, neither are
/// solids that are proven to stay apart within them (scene/self_pairs.hpp). Margins are for obstacles, whose place is
/// not known exactly: between solids of the robot contact alone counts.
///
/// A pose that is not finite, or has an attitude of no length, is in contact.
/// @pre joint angles of at most 1e5 rad
class DOWNWASH_EXPORT SpaceChecker {
 public:
    /// @throws InputError when a solid has a size that is not finite and positive, a joint is not finite or has no
    /// axis, limits are in the wrong order, or there are more than max_links links; keys as in SpaceRobotShape
    SpaceChecker(std::shared_ptr<const Scene> scene, const SpaceRobotShape& robot,
                 CollisionCheckerKind kind = CollisionCheckerKind::own);

    /// Who answers.
    [[nodiscard]] CollisionCheckerKind kind() const noexcept;

    /// How far the points of the robot are from what turns them: for bounds of motions (scene/space_motion.hpp).
    [[nodiscard]] const SpaceReach& reach() const noexcept;

    /// No point of the robot is farther from the multirotor's centre of mass at any joint angles [m].
    [[nodiscard]] double robot_reach_m() const noexcept;

    /// Whether a body of the robot is nearer than `margin_m` (>= 0) to an obstacle, or touches it, or the robot touches
    /// itself. Every such pose is found; a pose up to 1e-8 m farther away may be reported too.
    [[nodiscard]] bool is_nearer_than(const SpacePose& pose, double margin_m) const;

    /// Smallest distance from the robot to any obstacle [m] if it is below `enough_m`, else `enough_m`; <= 0 on contact
    /// with an obstacle or with itself.
    [[nodiscard]] double clearance_m(const SpacePose& pose,
                                     double enough_m = std::numeric_limits<double>::infinity()) const;

    /// The number in Scene::obstacles() of the obstacle nearest to the robot, if it is nearer than `within_m`. Of
    /// several in contact, any. Computed by our own geometry, whatever the kind.
    [[nodiscard]] std::optional<std::size_t> nearest_obstacle(const SpacePose& pose, double within_m) const;

    /// Smallest distance between two solids of the robot that are compared [m] if it is below `enough_m`, else
    /// `enough_m`; <= 0 on contact.
    [[nodiscard]] double self_clearance_m(const SpacePose& pose,
                                          double enough_m = std::numeric_limits<double>::infinity()) const;

    /// Two bodies of a robot: 0 is the multirotor, 1 the first link.
    struct Bodies {
        std::size_t first, second;

        friend bool operator==(const Bodies&, const Bodies&) = default;
    };
    /// Two bodies that touch each other, for messages. Of several pairs, any.
    [[nodiscard]] std::optional<Bodies> touching_bodies(const SpacePose& pose) const;

    /// How far a robot may move from a pose until the next look, each at least 0.
    struct FreeMotion {
        double to_obstacles_m = 0;  ///< by motion_m(): before, it is not nearer than the margin to an obstacle
        double to_itself_m = 0;     ///< by joint_motion_m(): before, it does not touch itself, if joints within their
                                    ///< limits stay within them, up to joint_swing_rad

        [[nodiscard]] bool is_none() const noexcept { return to_obstacles_m <= 0 || to_itself_m <= 0; }
    };
    /// At most `enough_m` each, 0 if it is nearer already.
    [[nodiscard]] FreeMotion free_motion(const SpacePose& pose, double margin_m, double enough_m) const;

    /// Whether the robot is nearer than a margin to an obstacle, or touches one or itself, at some pose between two
    /// poses, ends included. Between them position and joints change evenly, and the attitude turns the shorter way at
    /// an even rate. Parts of the way are halved until the middle of one is nearer than the margin (true), or the
    /// motion that is left on either side of it is proven not to come nearer. Parts of at most a millimetre are not
    /// halved further: with `false` the robot is nowhere nearer than the margin less half a millimetre.
    [[nodiscard]] bool comes_nearer_between(const SpacePose& from, const SpacePose& to, double margin_m) const;

 private:
    struct Impl;
    std::shared_ptr<const Impl> impl_;
};

}  // namespace downwash
