#pragma once

// Private to simulation/: how a level robot turns its arm and itself so that its hand points somewhere, in closed form
// (docs/model.md 7.10).

#include <array>
#include <optional>
#include <vector>

#include "downwash/base/random.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/simulation/space_arm_angles.hpp"

namespace downwash::simulation {

/// The arm and yaw of a level robot.
struct Heading {
    JointAngles joints{};
    double yaw_rad = 0;
};

/// A vector of the level robot's body, in the world.
[[nodiscard]] Vector3 yawed(double yaw_rad, const Vector3& v) noexcept;

/// What a goal asks of the arm of a level robot: a vector of its hand within a cone of the world; of a full pose the
/// attitude too.
struct Aim {
    Vector3 of_hand, to;
    double cone_rad;
    const std::array<double, 4>* attitude = nullptr;

    /// The angles above the level within which the vector of the hand has to be.
    [[nodiscard]] AngleRange elevation() const noexcept;
};

/// Yaws from `middle_rad` - `half_rad` to `middle_rad` + `half_rad`; at half a turn all.
struct YawRange {
    double middle_rad, half_rad;

    /// The yaw in it that is nearest to another one.
    [[nodiscard]] double nearest_to(double yaw_rad) const noexcept;
};

/// The yaws at which an arm aims. @pre the elevation of the arm is within that of the aim
[[nodiscard]] YawRange yaws_of(const Aim& aim, const SpaceArmAngles& arm, const JointAngles& at) noexcept;

/// An arm and a yaw that aim, drawn. Nothing where the joints that were drawn do not allow it.
[[nodiscard]] std::optional<Heading> drawn_heading(const Aim& aim, const SpaceArmAngles& arm, Random& random);

/// Some ways to turn the arm so that it aims, from what it is, each with the nearest yaw.
[[nodiscard]] std::vector<Heading> headings_near(const Aim& aim, const SpaceArmAngles& arm, const Heading& from);

}  // namespace downwash::simulation
