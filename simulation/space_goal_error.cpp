#include "downwash/simulation/space_goal_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/scene/line_of_sight.hpp"
#include "downwash/scene/space_motion.hpp"
#include "downwash/simulation/space_tool.hpp"
#include "downwash/simulation/space_touch_place.hpp"
#include "downwash/simulation/space_world.hpp"

namespace downwash {
namespace {

/// Modulo a turn, 0 to pi.
double turn_rad(double a_rad, double b_rad) {
    return std::abs(lane::wrap_angle(a_rad - b_rad));
}

/// What an error is made of.
struct Seen {
    const SpaceRobot& robot;
    const SpacePose& pose;
    const Scene& scene;
    const SpaceWorld& world;
};

SpaceGoalError error_of(const SpaceConfigurationGoal& goal, const Seen& at) {
    SpaceGoalError error;
    Vector3 apart_m{};
    const std::optional<double> place_m[] = {goal.x_m, goal.y_m, goal.z_m};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        apart_m[axis] = place_m[axis] ? at.pose.position_m[axis] - *place_m[axis] : 0;
    }
    error.distance_m = length_of(apart_m);
    if (goal.yaw_rad) {
        error.angle_rad = turn_rad(yaw_of(at.pose.attitude), *goal.yaw_rad);
    }
    for (std::size_t i = 0; i < goal.joints_rad.size(); ++i) {
        error.angle_rad = std::max(error.angle_rad, turn_rad(at.pose.joints_rad[i], goal.joints_rad[i]));
    }
    error.used_share = std::max(error.distance_m / goal.tolerance_m, error.angle_rad / goal.tolerance_rad);
    return error;
}

SpaceGoalError error_of(const SpaceEndEffectorGoal& goal, const Seen& at) {
    const SpaceToolPose tool = tool_at(at.robot, at.pose);
    SpaceGoalError error;
    error.distance_m = length_of(tool.position_m - goal.position_m);
    error.angle_rad = goal.direction ? angle_between_rad(tool.direction, *goal.direction) : 0;
    error.used_share = std::max(error.distance_m / goal.tolerance_m, error.angle_rad / goal.direction_tolerance_rad);
    return error;
}

SpaceGoalError error_of(const SpacePoseGoal& goal, const Seen& at) {
    const SpaceToolPose tool = tool_at(at.robot, at.pose);
    SpaceGoalError error;
    error.distance_m = length_of(tool.position_m - goal.position_m);
    error.angle_rad = turn_between_rad(tool.attitude.data(), attitude_of(goal.rpy_rad).data());
    error.used_share = std::max(error.distance_m / goal.tolerance_m, error.angle_rad / goal.tolerance_rad);
    return error;
}

SpaceGoalError error_of(const SpaceCameraGoal& goal, const Seen& at) {
    const SpaceToolPose tool = tool_at(at.robot, at.pose);
    const Vector3 camera_m = among_obstacles(tool.position_m, at.world);
    const Vector3 points = among_obstacles(tool.position_m + tool.direction, at.world) - camera_m;
    const Vector3 line = goal.target_m - camera_m;
    const double away_m = length_of(line);
    SpaceGoalError error;
    error.distance_m = std::max({0.0, goal.nearest_m - away_m, away_m - goal.farthest_m});
    const double aim_rad = angle_between_rad(points, line);
    const double view_rad = goal.direction ? angle_between_rad(*goal.direction, line) : 0;
    error.angle_rad = std::max(aim_rad, view_rad);
    const double half_m = 0.5 * (goal.farthest_m - goal.nearest_m);
    error.used_share = std::max({std::abs(away_m - 0.5 * (goal.nearest_m + goal.farthest_m)) / half_m,
                                 aim_rad / goal.aim_tolerance_rad, view_rad / goal.view_cone_rad});
    error.is_hidden = goal.sees && !sees(at.scene, camera_m, goal.target_m);
    return error;
}

SpaceGoalError error_of(const SpaceContactGoal& /*goal*/, const Seen& /*at*/) {
    SpaceGoalError error;
    error.used_share = HUGE_VAL;
    return error;
}

}  // namespace

bool sees(const Scene& scene, const Vector3& camera_m, const Vector3& target_m) {
    const Vector3 line = target_m - camera_m;
    const double length_m = length_of(line);
    if (length_m <= sight_end_m) {
        return true;
    }
    return is_line_clear(scene, camera_m, camera_m + ((length_m - sight_end_m) / length_m) * line, sight_radius_m);
}

SpaceGoalError goal_error(const SpaceGoal& goal, const SpaceRobot& robot, const SpacePose& pose, const Scene& scene,
                          const SpaceWorld& world) {
    return std::visit([&](const auto& kind) { return error_of(kind, Seen{robot, pose, scene, world}); }, goal.kind);
}

SpaceGoalError goal_error(const SpaceTouch& touch, const SpaceRobot& robot, const SpacePose& pose) {
    SpaceGoalError error;
    error.distance_m = length_of(middle_of(touch, robot, pose) - touch.waiting_m);
    if (touch.part == TouchingPart::end_effector) {
        error.angle_rad = angle_between_rad(tool_at(robot, pose).direction, -1 * touch.normal);
    }
    error.used_share = std::max(error.distance_m / touch.tolerance_m, error.angle_rad / touch_angle_rad);
    return error;
}

}  // namespace downwash
