#include "downwash/simulation/goal.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/rigid_body.hpp"

namespace downwash {
namespace {

double angle_between(double a_rad, double b_rad) {
    return std::abs(lane::wrap_angle(a_rad - b_rad));
}

GoalDeviation deviation(const EndEffectorGoal& goal, const PlantModel& model, const PlanarPose& pose) {
    const auto attitude = dynamics::attitude(model, pose.pitch_rad, pose.arm_rad);
    const auto tip = dynamics::end_effector_position(model, attitude, pose.x_m, pose.z_m);
    return {tip.x - goal.x_m, tip.z - goal.z_m,
            goal.direction_rad ? angle_between(pose.pitch_rad + pose.arm_rad, *goal.direction_rad) : 0};
}

GoalDeviation deviation(const ConfigurationGoal& goal, const PlanarPose& pose) {
    return {goal.x_m ? pose.x_m - *goal.x_m : 0, goal.z_m ? pose.z_m - *goal.z_m : 0,
            goal.arm_rad ? angle_between(pose.arm_rad, *goal.arm_rad) : 0};
}

template <class Kind>
GoalTolerance tolerance(const Kind& goal, double angle_rad) {
    return {goal.tolerance_x_m.value_or(goal.tolerance_m), goal.tolerance_z_m.value_or(goal.tolerance_m),
            !goal.tolerance_x_m && !goal.tolerance_z_m, angle_rad};
}

double distance_m(const GoalDeviation& d) {
    return std::sqrt(d.x_m * d.x_m + d.z_m * d.z_m);
}

}  // namespace

std::span<const Goal> alternatives(const Goal& goal) noexcept {
    return goal.any_of.empty() ? std::span<const Goal>(&goal, 1) : std::span<const Goal>(goal.any_of);
}

GoalTolerance GoalTolerance::times(double share) const noexcept {
    return {share * x_m, share * z_m, is_disc, share * angle_rad};
}

GoalTolerance GoalTolerance::usable() const noexcept {
    return times(usable_tolerance_share);
}

double GoalTolerance::used_share(const GoalDeviation& d) const noexcept {
    const double of_place = is_disc ? distance_m(d) / x_m : std::max(std::abs(d.x_m) / x_m, std::abs(d.z_m) / z_m);
    return std::max(of_place, d.angle_rad / angle_rad);
}

GoalTolerance tolerance_of(const Goal& goal) noexcept {
    if (goal.end_effector) {
        return tolerance(*goal.end_effector, goal.end_effector->direction_tolerance_rad);
    }
    const ConfigurationGoal& configuration = *goal.configuration;
    return tolerance(configuration, configuration.tolerance_rad);
}

GoalDeviation goal_deviation(const Goal& goal, const PlantModel& model, const PlanarPose& pose) {
    return goal.end_effector ? deviation(*goal.end_effector, model, pose) : deviation(*goal.configuration, pose);
}

std::optional<double> level_arm_rad(const Goal& goal) noexcept {
    return goal.end_effector ? goal.end_effector->direction_rad : goal.configuration->arm_rad;
}

Configuration placed_at(const Goal& goal, const PlantModel& model, Configuration c, double dx_m, double dz_m) {
    if (goal.end_effector) {
        const auto tip =
            dynamics::end_effector_position(model, dynamics::attitude(model, 0.0, c[plane::arm]), 0.0, 0.0);
        return {goal.end_effector->x_m + dx_m - tip.x, goal.end_effector->z_m + dz_m - tip.z, c[plane::arm]};
    }
    const ConfigurationGoal& pose = *goal.configuration;
    return {pose.x_m ? *pose.x_m + dx_m : c[plane::x], pose.z_m ? *pose.z_m + dz_m : c[plane::z], c[plane::arm]};
}

GoalError goal_error(const Goal& goal, const PlantModel& model, const PlanarPose& pose) {
    const Goal& nearest = nearest_goal(goal, model, pose);
    const GoalDeviation d = goal_deviation(nearest, model, pose);
    return {distance_m(d), d.angle_rad, tolerance_of(nearest).used_share(d)};
}

const Goal& nearest_goal(const Goal& goal, const PlantModel& model, const PlanarPose& pose) {
    if (goal.any_of.empty()) {
        return goal;
    }
    const auto share = [&](const Goal& each) {
        return tolerance_of(each).used_share(goal_deviation(each, model, pose));
    };
    return *std::min_element(goal.any_of.begin(), goal.any_of.end(),
                             [&](const Goal& a, const Goal& b) { return share(a) < share(b); });
}

double motion_within_goal_m(const Goal& goal, const PlantModel& model, const PlanarPose& pose, double body_reach_m) {
    const Goal& nearest = nearest_goal(goal, model, pose);
    const GoalDeviation d = goal_deviation(nearest, model, pose);
    const GoalTolerance tolerance = tolerance_of(nearest);
    const double distance_left_m = tolerance.is_disc
                                       ? tolerance.x_m - distance_m(d)
                                       : std::min(tolerance.x_m - std::abs(d.x_m), tolerance.z_m - std::abs(d.z_m));
    // The arm's direction turns by at most motion / length, the body by motion / reach, and their difference is the
    // arm's angle.
    const double turn_per_m = 1 / model.arm_length_m + (nearest.configuration ? 1 / body_reach_m : 0);
    const double angle_left_m = (tolerance.angle_rad - d.angle_rad) / turn_per_m;
    return level_arm_rad(nearest) ? std::min(distance_left_m, angle_left_m) : distance_left_m;
}

const Touch* touch_at(const Goal& goal, const PlantModel& model, const PlanarPose& level) {
    const Goal& nearest = nearest_goal(goal, model, level);
    return nearest.touch ? &*nearest.touch : nullptr;
}

}  // namespace downwash
