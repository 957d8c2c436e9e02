#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/simulation/contact_goal.hpp"

// Where a flight in space must end and stay. Places and directions are those of the world.

namespace downwash {

/// 5 degrees.
inline constexpr double default_angle_tolerance_rad = 0.08726646259971647;

/// The end effector at a point; optionally with a direction in which it points.
struct SpaceEndEffectorGoal {
    Vector3 position_m = {};
    double tolerance_m = 0.1;                                      ///< Euclidean distance, > 0
    std::optional<Vector3> direction;                              ///< of the tool, of any length but zero; empty: any
    double direction_tolerance_rad = default_angle_tolerance_rad;  ///< half angle of a cone about it, > 0

    friend bool operator==(const SpaceEndEffectorGoal&, const SpaceEndEffectorGoal&) = default;
};

/// The end effector at a point with all of its attitude.
struct SpacePoseGoal {
    Vector3 position_m = {};
    Vector3 rpy_rad = {};                                ///< of the last link's axes: R = Rz(yaw) Ry(pitch) Rx(roll)
    double tolerance_m = 0.1;                            ///< > 0
    double tolerance_rad = default_angle_tolerance_rad;  ///< of the one turn between both attitudes, > 0

    friend bool operator==(const SpacePoseGoal&, const SpacePoseGoal&) = default;
};

/// 10 degrees: the target is in the middle third of a picture 60 degrees wide. Half of that would be less than what
/// offsets of joints and attitude, and gusts, leave of an aim.
inline constexpr double default_aim_tolerance_rad = 0.17453292519943295;

/// A camera, the end effector, that looks at a point from a distance.
struct SpaceCameraGoal {
    Vector3 target_m = {};
    double nearest_m = 0, farthest_m = 0;  ///< distance of the end effector from the target, 0 < nearest < farthest
    std::optional<Vector3> direction;      ///< in which it should look, of any length but zero; empty: any
    double view_cone_rad = 0.5235987755982988;  ///< greatest angle between that direction and the line to the target
    double aim_tolerance_rad = default_aim_tolerance_rad;  ///< greatest angle between the tool's direction and the line
    bool sees = true;                                      ///< whether no obstacle may stand between camera and target

    friend bool operator==(const SpaceCameraGoal&, const SpaceCameraGoal&) = default;
};

/// The multirotor and its arm; an empty coordinate is free.
struct SpaceConfigurationGoal {
    std::optional<double> x_m, y_m, z_m, yaw_rad;
    std::vector<double> joints_rad;                      ///< of all joints; empty: free
    double tolerance_m = 0.1;                            ///< Euclidean distance over the given coordinates, > 0
    double tolerance_rad = default_angle_tolerance_rad;  ///< of yaw and of each joint, > 0

    friend bool operator==(const SpaceConfigurationGoal&, const SpaceConfigurationGoal&) = default;
};

/// A surface that the robot must touch and press on, along its normal.
struct SpaceContactGoal {
    std::string obstacle;  ///< name of the obstacle
    double force_n = 5;    ///< normal force that is held, > 0
    TouchingPart part = TouchingPart::end_effector;
    std::optional<Vector3> position_m;        ///< point near which it touches; empty: anywhere
    double tolerance_m = 0.1;                 ///< distance from that point, > 0
    std::optional<double> force_tolerance_n;  ///< allowed error of the mean over a second, > 0; empty: a fifth
    double standoff_m = 0.3;                  ///< distance from the surface before and after, > 0
    double speed_m_s = 0.1;                   ///< of approach and leaving, > 0

    /// The allowed error of the mean force over a second [N].
    [[nodiscard]] double tolerance_n() const noexcept { return force_tolerance_n.value_or(0.2 * force_n); }

    friend bool operator==(const SpaceContactGoal&, const SpaceContactGoal&) = default;
};

using SpaceGoalKind =
    std::variant<SpaceConfigurationGoal, SpaceEndEffectorGoal, SpacePoseGoal, SpaceCameraGoal, SpaceContactGoal>;

/// A default goal leaves every coordinate free, which is an error.
struct SpaceGoal {
    SpaceGoalKind kind;                  ///< unused where there are alternatives
    double hold_s = 5;                   ///< how long the last reference point is held, >= 1
    std::vector<SpaceGoal> any_of = {};  ///< alternatives, of which any will do; not nested

    friend bool operator==(const SpaceGoal&, const SpaceGoal&) = default;
};

}  // namespace downwash
