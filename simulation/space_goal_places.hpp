#pragma once

// Private to simulation/: what drawing configurations for a goal (space_goal_drawing.cpp) and finding the nearest one
// (space_goal_nearest.cpp) share.

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "downwash/base/space_bounds.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_aim.hpp"
#include "downwash/simulation/space_arm_angles.hpp"
#include "downwash/simulation/space_configuration.hpp"
#include "downwash/simulation/space_facets.hpp"
#include "downwash/simulation/space_goal.hpp"
#include "downwash/simulation/space_goal_sampler.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash {

struct SpaceGoalSampler::Impl {
    using Aim = simulation::Aim;
    using Heading = simulation::Heading;
    using Found = std::optional<SpaceConfiguration>;

    static constexpr Vector3 up{0, 0, 1};

    /// A goal without alternatives, made ready.
    struct One {
        SpaceGoal goal;
        std::array<double, 4> attitude{};       ///< of a pose
        Vector3 up_in_hand{};                   ///< of a pose
        std::vector<simulation::Facet> facets;  ///< that a contact may touch
        std::shared_ptr<const Scene> touched;
    };

    SpaceRobot robot;
    SpaceBounds bounds;
    std::shared_ptr<const Scene> scene;
    SpaceChecker checker;
    double margin_m;
    SpaceArmAngles arm;
    std::vector<One> ones;

    /// The robot with its end effector at a place.
    [[nodiscard]] SpaceConfiguration placed(const Heading& heading, const Vector3& end_effector_m) const;
    [[nodiscard]] static Heading heading_of(const SpaceConfiguration& at);
    [[nodiscard]] Vector3 end_of(const SpaceConfiguration& at) const;

    // Cameras.

    /// The line of sight of a camera that points somewhere, as near to that as the goal's direction allows.
    [[nodiscard]] static Vector3 line_of(const SpaceCameraGoal& goal, const Vector3& points, double share);
    [[nodiscard]] static Aim view_of(const SpaceCameraGoal& goal, const Vector3& tool, double share);

    // Configurations.

    /// An angle of a joint within its limits that is the same as another one, or next to it.
    [[nodiscard]] double in_range(std::size_t joint, double angle_rad, double about_rad) const;
    [[nodiscard]] static std::array<bool, 3> given(const SpaceConfigurationGoal& goal);
    [[nodiscard]] static Vector3 place_of(const SpaceConfigurationGoal& goal);
    /// The configuration, if the joints that its limits allow are near enough.
    [[nodiscard]] Found meets(const SpaceConfigurationGoal& goal, const SpaceConfiguration& at, double share) const;

    // Contacts.

    /// The robot in front of a point of a surface, moved to where it has to wait. Nothing if there is no touch from
    /// there.
    /// @param n which way out of the surface
    [[nodiscard]] Found before_touch(const SpaceContactGoal& goal, const One& one, const Heading& heading,
                                     const Vector3& surface_m, const Vector3& n, double share) const;
};

}  // namespace downwash
