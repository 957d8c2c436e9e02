#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/base/random.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/scene/space_robot_shape.hpp"
#include "downwash/simulation/space_robot.hpp"

// Joint angles with which the arm of a level robot points somewhere, in closed form (docs/model.md 7.10).

namespace downwash {

/// The angles of an arm's joints [rad]; those that it lacks say nothing.
using JointAngles = std::array<double, max_links>;

/// Angles between two ends, which may be the same [rad].
struct AngleRange {
    double low_rad = 0, high_rad = 0;
};

/// Angles of one joint: some ranges, in no order.
struct AngleRanges {
    static constexpr std::size_t most = 16;
    std::array<AngleRange, most> all{};
    std::size_t count = 0;

    /// An angle in them, evenly spread; of single angles alone any of them. Nothing without a range.
    [[nodiscard]] DOWNWASH_EXPORT std::optional<double> drawn(Random& random) const;
    /// The angle in them that is nearest to another one. Nothing without a range.
    [[nodiscard]] DOWNWASH_EXPORT std::optional<double> nearest(double to_rad) const;
};

/// How a number changes as one joint turns: a + b cos q + c sin q.
struct JointWave {
    double a = 0, b = 0, c = 0;

    /// The angles of a joint, within its range, at which the number lies within [least, most].
    /// @param range of the joint; of more than eight turns some are left out
    [[nodiscard]] DOWNWASH_EXPORT AngleRanges within(double least, double most, const AngleRange& range) const;
    /// The angle within a range of a joint at which the number is nearest to `wanted`; of several one of them.
    [[nodiscard]] DOWNWASH_EXPORT double nearest_to(double wanted, const AngleRange& range) const;
};

/// The arm of a level robot. Vectors of the hand are in the axes of the last link, those of the body in the
/// multirotor's; without an arm both are the same. Immutable; nothing allocates.
class DOWNWASH_EXPORT SpaceArmAngles {
 public:
    /// @pre space_robot_errors(robot) is empty
    explicit SpaceArmAngles(const SpaceRobot& robot);

    [[nodiscard]] std::size_t joints() const noexcept { return joints_; }
    /// The range of a joint: its limits, or a whole turn about zero where it has none.
    [[nodiscard]] const AngleRange& range(std::size_t joint) const noexcept { return range_[joint]; }
    /// The same, but about an angle instead of zero where it has no limits: what is a turn away is nearer there.
    [[nodiscard]] AngleRange range_about(std::size_t joint, double angle_rad) const noexcept;
    [[nodiscard]] bool is_limited(std::size_t joint) const noexcept { return is_limited_[joint]; }
    /// Where the end effector points, in the hand; of length 1.
    [[nodiscard]] const Vector3& tool() const noexcept { return tool_; }

    /// A vector of the hand, in the body.
    [[nodiscard]] Vector3 outward(const JointAngles& at, const Vector3& of_hand) const noexcept;
    /// A vector of the body, in the hand.
    [[nodiscard]] Vector3 inward(const JointAngles& at, const Vector3& of_body) const noexcept;
    /// The end effector, from the multirotor's centre of mass, in the body [m].
    [[nodiscard]] Vector3 end_effector_m(const JointAngles& at) const noexcept;

    /// The angle of a vector of the hand above the level, -pi/2 to pi/2 [rad].
    [[nodiscard]] double elevation_rad(const JointAngles& at, const Vector3& of_hand) const noexcept;
    /// The upright part of a vector of the hand, as one joint turns.
    [[nodiscard]] JointWave upright(const JointAngles& at, std::size_t joint, const Vector3& of_hand) const noexcept;

    /// Each joint anywhere within its range.
    [[nodiscard]] JointAngles drawn(Random& random) const;

    /// Angles with which a vector of the hand has an elevation within a range: all joints but one or two are drawn, the
    /// others follow. Of every fourth try the drawn ones are first turned, one after the other, as near as they get.
    /// Nothing where they cannot, which another try may mend.
    /// @param of_hand of length 1   @param elevation_rad within [-pi/2, pi/2]
    [[nodiscard]] std::optional<JointAngles> drawn_with(const Vector3& of_hand, const AngleRange& elevation_rad,
                                                        Random& random) const;

    /// One joint turned, the least possible, so that a vector of the hand has an elevation within a range.
    [[nodiscard]] std::optional<JointAngles> turned(const JointAngles& from, std::size_t joint, const Vector3& of_hand,
                                                    const AngleRange& elevation_rad) const;
    /// Joints turned one after the other, from `first` on, each as far as it helps.
    [[nodiscard]] std::optional<JointAngles> turned_in_turn(const JointAngles& from, std::size_t first,
                                                            const Vector3& of_hand,
                                                            const AngleRange& elevation_rad) const;
    /// Two joints turned, so that the vertical is a vector of the hand: the inner one has a solution for each of up to
    /// two of the outer one. The one that turns both least, by the greater of both ways.
    /// @param inner,outer joints, inner < outer   @param up_in_hand of length 1
    [[nodiscard]] std::optional<JointAngles> turned(const JointAngles& from, std::size_t inner, std::size_t outer,
                                                    const Vector3& up_in_hand) const;

 private:
    /// Through the joints `first` to `last` - 1, from the outermost inward or the other way round.
    [[nodiscard]] Vector3 outward(const JointAngles& at, Vector3 v, std::size_t first, std::size_t last) const noexcept;
    [[nodiscard]] Vector3 inward(const JointAngles& at, Vector3 v, std::size_t first, std::size_t last) const noexcept;
    [[nodiscard]] bool has(const JointAngles& at, const Vector3& of_hand, const AngleRange& elevation_rad) const;
    [[nodiscard]] std::optional<JointAngles> mended(JointAngles at, std::size_t joint, const Vector3& of_hand,
                                                    const AngleRange& elevation_rad) const;
    /// `choose(ranges, angle before)` chooses an angle of the outer joint, then of the inner one.
    template <class Choose>
    [[nodiscard]] std::optional<JointAngles> solved(JointAngles at, std::size_t inner, std::size_t outer,
                                                    const Vector3& up_in_hand, const Choose& choose) const;

    std::size_t joints_ = 0;
    std::array<Vector3, max_links> axis_{}, joint_m_{};
    std::array<AngleRange, max_links> range_{};
    std::array<bool, max_links> is_limited_{};
    Vector3 end_m_{}, tool_{};
};

}  // namespace downwash
