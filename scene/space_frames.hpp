#pragma once

// Where the bodies of a robot in space are, and how far they reach. Private: not installed.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "downwash/scene/robot_solids.hpp"
#include "downwash/scene/space_motion.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/scene/space_robot_shape.hpp"

namespace downwash {

/// The frames of a robot: that of the multirotor, then those of the links, each from its joint.
struct SpaceFrames {
    std::array<RobotFrame, max_links + 1> all;
    std::size_t count = 0;

    operator std::span<const RobotFrame>() const noexcept { return {all.data(), count}; }  // NOLINT: it is one
    const RobotFrame& operator[](std::size_t i) const noexcept { return all[i]; }
};

/// The joints of a serial arm.
class SpaceArm {
 public:
    SpaceArm() = default;
    /// @pre the robot is valid
    explicit SpaceArm(const SpaceRobotShape& robot);

    [[nodiscard]] std::size_t links() const noexcept { return joints_.size(); }

    /// Every frame in the world.
    [[nodiscard]] SpaceFrames frames_at(const SpacePose& pose) const noexcept;

    /// The frames of one body and those mounted on it up to another, as seen from the first.
    /// @param from,to numbers of frames, from <= to
    [[nodiscard]] SpaceFrames frames_seen_from(std::size_t from, std::size_t to,
                                               const std::array<double, max_links>& joints_rad) const noexcept;

    /// Whether no joint is farther beyond its limits than an arm that hovers at one swings about it, joint_swing_rad.
    [[nodiscard]] bool is_within_limits(const std::array<double, max_links>& joints_rad) const noexcept;
    [[nodiscard]] double lower_limit_rad(std::size_t joint) const noexcept { return joints_[joint].lower_rad; }
    [[nodiscard]] double upper_limit_rad(std::size_t joint) const noexcept { return joints_[joint].upper_rad; }

    /// How far the solids reach.
    [[nodiscard]] SpaceReach reach_of(const std::vector<RobotPiece>& pieces) const noexcept;

 private:
    struct Joint {
        Vector3 at_m;
        Vector3 axis;  ///< of length 1
        double lower_rad, upper_rad;
    };
    [[nodiscard]] static RobotFrame mounted(const RobotFrame& on, const Joint& joint, double angle_rad) noexcept;

    std::vector<Joint> joints_;
};

/// The greatest distance of a point of a solid from the origin of its frame [m].
[[nodiscard]] double reach_m(const Convex& convex) noexcept;

/// The greatest distance of a point of a solid from the line through the origin along a vector of length 1 [m], or a
/// little more of solids with a disc.
[[nodiscard]] double reach_about_m(const Convex& convex, const Vector3& axis) noexcept;

}  // namespace downwash
