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

template <class Kind>
GoalTolerance place_and_angle(const Kind& goal, double angle_rad) {
    return {goal.tolerance_x_m.value_or(goal.tolerance_m), goal.tolerance_z_m.value_or(goal.tolerance_m),
            !goal.tolerance_x_m && !goal.tolerance_z_m, angle_rad};
}

template <class Kind>
void widen_place(Kind& goal, double factor) {
    goal.tolerance_m *= factor;
    for (std::optional<double>* tolerance : {&goal.tolerance_x_m, &goal.tolerance_z_m}) {
        if (*tolerance) {
            **tolerance *= factor;
        }
    }
}

double raised(double from_m, double by_m) {
    return std::round(1e3 * (from_m + by_m)) / 1e3;
}

// A configuration.

GoalTolerance tolerance(const ConfigurationGoal& goal) {
    return place_and_angle(goal, goal.tolerance_rad);
}

GoalDeviation deviation(const ConfigurationGoal& goal, const PlantModel& /*model*/, const PlanarPose& pose) {
    return {goal.x_m ? pose.x_m - *goal.x_m : 0, goal.z_m ? pose.z_m - *goal.z_m : 0,
            goal.arm_rad ? angle_between(pose.arm_rad, *goal.arm_rad) : 0};
}

std::optional<double> level_arm(const ConfigurationGoal& goal) {
    return goal.arm_rad;
}

Configuration placed(const ConfigurationGoal& goal, const PlantModel& /*model*/, const Configuration& c, double dx_m,
                     double dz_m) {
    return {goal.x_m ? *goal.x_m + dx_m : c[plane::x], goal.z_m ? *goal.z_m + dz_m : c[plane::z], c[plane::arm]};
}

GoalPart part(const ConfigurationGoal& /*goal*/) {
    return GoalPart::vehicle;
}

GoalDrawing drawing(const ConfigurationGoal& goal) {
    return {goal.x_m, goal.z_m, {}};
}

void lift(ConfigurationGoal& goal, double by_m) {
    if (goal.z_m) {
        goal.z_m = raised(*goal.z_m, by_m);
    }
}

void widen(ConfigurationGoal& goal, double factor) {
    widen_place(goal, factor);
}

// The end effector at a point.

GoalTolerance tolerance(const EndEffectorGoal& goal) {
    return place_and_angle(goal, goal.direction_tolerance_rad);
}

GoalDeviation deviation(const EndEffectorGoal& goal, const PlantModel& model, const PlanarPose& pose) {
    const auto attitude = dynamics::attitude(model, pose.pitch_rad, pose.arm_rad);
    const auto tip = dynamics::end_effector_position(model, attitude, pose.x_m, pose.z_m);
    return {tip.x - goal.x_m, tip.z - goal.z_m,
            goal.direction_rad ? angle_between(pose.pitch_rad + pose.arm_rad, *goal.direction_rad) : 0};
}

std::optional<double> level_arm(const EndEffectorGoal& goal) {
    return goal.direction_rad;
}

Configuration placed(const EndEffectorGoal& goal, const PlantModel& model, const Configuration& c, double dx_m,
                     double dz_m) {
    const auto tip = dynamics::end_effector_position(model, dynamics::attitude(model, 0.0, c[plane::arm]), 0.0, 0.0);
    return {goal.x_m + dx_m - tip.x, goal.z_m + dz_m - tip.z, c[plane::arm]};
}

GoalPart part(const EndEffectorGoal& /*goal*/) {
    return GoalPart::end_effector;
}

GoalDrawing drawing(const EndEffectorGoal& goal) {
    return {goal.x_m, goal.z_m, {}};
}

void lift(EndEffectorGoal& goal, double by_m) {
    goal.z_m = raised(goal.z_m, by_m);
}

void widen(EndEffectorGoal& goal, double factor) {
    widen_place(goal, factor);
}

// A contact: the robot is at one of its places, and nowhere as long as they are not found.

GoalTolerance tolerance(const ContactGoal& goal) {
    return {goal.tolerance_m, goal.tolerance_m, true, 1};
}

GoalDeviation deviation(const ContactGoal& /*goal*/, const PlantModel& /*model*/, const PlanarPose& /*pose*/) {
    return {HUGE_VAL, HUGE_VAL, 0};
}

std::optional<double> level_arm(const ContactGoal& /*goal*/) {
    return std::nullopt;
}

Configuration placed(const ContactGoal& /*goal*/, const PlantModel& /*model*/, const Configuration& c, double /*dx_m*/,
                     double /*dz_m*/) {
    return c;
}

GoalPart part(const ContactGoal& goal) {
    return goal.part == TouchingPart::frame ? GoalPart::vehicle : GoalPart::end_effector;
}

GoalDrawing drawing(const ContactGoal& /*goal*/) {
    return {};
}

void lift(ContactGoal& /*goal*/, double /*by_m*/) {}

void widen(ContactGoal& /*goal*/, double /*factor*/) {}

double distance_m(const GoalDeviation& d) {
    return std::sqrt(d.x_m * d.x_m + d.z_m * d.z_m);
}

}  // namespace

bool may_touch(const Goal& goal) noexcept {
    return asks_for_contact(goal) || std::ranges::any_of(goal.any_of, asks_for_contact);
}

std::span<const Goal> alternatives(const Goal& goal) noexcept {
    if (!goal.places.empty()) {
        return goal.places;
    }
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
    return std::visit([](const auto& kind) { return tolerance(kind); }, goal.kind);
}

GoalDeviation goal_deviation(const Goal& goal, const PlantModel& model, const PlanarPose& pose) {
    return std::visit([&](const auto& kind) { return deviation(kind, model, pose); }, goal.kind);
}

std::optional<double> level_arm_rad(const Goal& goal) noexcept {
    return std::visit([](const auto& kind) { return level_arm(kind); }, goal.kind);
}

Configuration placed_at(const Goal& goal, const PlantModel& model, Configuration c, double dx_m, double dz_m) {
    return std::visit([&](const auto& kind) { return placed(kind, model, c, dx_m, dz_m); }, goal.kind);
}

GoalPart part_of(const Goal& goal) noexcept {
    return std::visit([](const auto& kind) { return part(kind); }, goal.kind);
}

GoalDrawing drawing_of(const Goal& goal) {
    return std::visit([](const auto& kind) { return drawing(kind); }, goal.kind);
}

void raise_goal(Goal& goal, double by_m) {
    std::visit([&](auto& kind) { lift(kind, by_m); }, goal.kind);
    goal.places.clear();
    for (Goal& each : goal.any_of) {
        raise_goal(each, by_m);
    }
}

void widen_goal(Goal& goal, double factor) {
    std::visit([&](auto& kind) { widen(kind, factor); }, goal.kind);
    goal.places.clear();
    for (Goal& each : goal.any_of) {
        widen_goal(each, factor);
    }
}

GoalError goal_error(const Goal& goal, const PlantModel& model, const PlanarPose& pose) {
    const Goal& nearest = nearest_goal(goal, model, pose);
    const GoalDeviation d = goal_deviation(nearest, model, pose);
    return {distance_m(d), d.angle_rad, tolerance_of(nearest).used_share(d)};
}

const Goal& nearest_goal(const Goal& goal, const PlantModel& model, const PlanarPose& pose) {
    const std::span<const Goal> all = alternatives(goal);
    const auto share = [&](const Goal& each) {
        return tolerance_of(each).used_share(goal_deviation(each, model, pose));
    };
    return *std::min_element(all.begin(), all.end(), [&](const Goal& a, const Goal& b) { return share(a) < share(b); });
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
    const double turn_per_m = 1 / model.arm_length_m + (part_of(nearest) == GoalPart::vehicle ? 1 / body_reach_m : 0);
    const double angle_left_m = (tolerance.angle_rad - d.angle_rad) / turn_per_m;
    return level_arm_rad(nearest) ? std::min(distance_left_m, angle_left_m) : distance_left_m;
}

const Touch* touch_at(const Goal& goal, const PlantModel& model, const PlanarPose& level) {
    const Goal& nearest = nearest_goal(goal, model, level);
    return nearest.touch ? &*nearest.touch : nullptr;
}

}  // namespace downwash
