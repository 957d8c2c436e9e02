#include "downwash/judge/goals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/judge/vehicle.hpp"

namespace downwash::judge {
namespace {

/// Between two directions, from 0 to pi.
double angle_between(double a_rad, double b_rad) {
    return std::abs(std::remainder(a_rad - b_rad, 2 * std::numbers::pi));
}

/// @param dx,dz deviation [m], 0 where the goal leaves it free   @param angle_rad the same for the angle
template <class Kind>
GoalDistance distance_of(const Kind& goal, double dx, double dz, double angle_rad, double tolerance_rad) {
    GoalDistance d;
    d.distance_m = std::hypot(dx, dz);
    const bool is_disc = !goal.tolerance_x_m && !goal.tolerance_z_m;
    d.used_share = is_disc ? d.distance_m / goal.tolerance_m
                           : std::max(std::abs(dx) / goal.tolerance_x_m.value_or(goal.tolerance_m),
                                      std::abs(dz) / goal.tolerance_z_m.value_or(goal.tolerance_m));
    d.used_share = std::max(d.used_share, angle_rad / tolerance_rad);
    return d;
}

Planar tip_of(const ArmParameters& arm, const PlanarPose& pose) {
    return Planar{pose.x_m, pose.z_m} + from_body({arm.joint_x_m, arm.joint_z_m}, pose.pitch_rad) +
           arm.length_m * arm_direction(pose.pitch_rad, pose.arm_rad);
}

GoalDistance distance(const ConfigurationGoal& at, const ArmParameters& /*arm*/, const PlanarPose& pose) {
    return distance_of(at, at.x_m ? pose.x_m - *at.x_m : 0, at.z_m ? pose.z_m - *at.z_m : 0,
                       at.arm_rad ? angle_between(pose.arm_rad, *at.arm_rad) : 0, at.tolerance_rad);
}

GoalDistance distance(const EndEffectorGoal& at, const ArmParameters& arm, const PlanarPose& pose) {
    const Planar tip = tip_of(arm, pose);
    const double angle = at.direction_rad ? angle_between(pose.pitch_rad + pose.arm_rad, *at.direction_rad) : 0;
    return distance_of(at, tip.x - at.x_m, tip.z - at.z_m, angle, at.direction_tolerance_rad);
}

/// A contact is reached at its places.
GoalDistance distance(const ContactGoal& /*at*/, const ArmParameters& /*arm*/, const PlanarPose& /*pose*/) {
    return {HUGE_VAL, HUGE_VAL};
}

GoalDistance single(const Goal& goal, const ArmParameters& arm, const PlanarPose& pose) {
    GoalDistance d = std::visit([&](const auto& kind) { return distance(kind, arm, pose); }, goal.kind);
    d.hold_s = goal.hold_s;
    return d;
}

/// The alternative whose tolerances a pose uses least, and how far it is from that.
std::pair<const Goal*, GoalDistance> nearest(const Goal& goal, const ArmParameters& arm, const PlanarPose& pose) {
    const std::vector<Goal>& all = goal.places.empty() ? goal.any_of : goal.places;
    if (all.empty()) {
        return {&goal, single(goal, arm, pose)};
    }
    std::pair<const Goal*, GoalDistance> least{};
    for (const Goal& each : all) {
        const GoalDistance d = single(each, arm, pose);
        if (least.first == nullptr || d.used_share < least.second.used_share) {
            least = {&each, d};
        }
    }
    return least;
}

PlanarPose level(const ReferencePoint& point) {
    return {point.position[0], point.position[1], 0, point.position[2]};
}

std::int64_t ticks_of(double duration_s, double tick_s) {
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(duration_s / tick_s - 1e-9)));
}

}  // namespace

GoalDistance goal_distance(const Goal& goal, const ArmParameters& arm, const PlanarPose& pose) {
    return nearest(goal, arm, pose).second;
}

const Touch* touch_after(const Goal& goal, const ArmParameters& arm, const PlanarPose& pose) {
    const std::optional<Touch>& touch = nearest(goal, arm, pose).first->touch;
    return touch ? &*touch : nullptr;
}

std::vector<std::int64_t> hover_ends(const Plan& plan, std::span<const Goal> goals, const ArmParameters& arm) {
    std::vector<std::int64_t> ends;
    const auto stands = [](const ReferencePoint& point) {
        return std::all_of(point.velocity, point.velocity + 3, [](double v) { return v == 0; }) &&
               std::all_of(point.acceleration, point.acceleration + 3, [](double a) { return a == 0; });
    };
    for (std::size_t i = 1; i < plan.reference.size() && ends.size() + 1 < goals.size(); ++i) {
        const ReferenceKnot& from = plan.reference[i - 1];
        const ReferenceKnot& to = plan.reference[i];
        const GoalDistance d = goal_distance(goals[ends.size()], arm, level(to.point));
        if (from.point == to.point && stands(to.point) && d.used_share <= 1 &&
            to.tick - from.tick >= ticks_of(d.hold_s, plan.tick_s)) {
            ends.push_back(to.tick);
        }
    }
    const ReferenceKnot& last = plan.reference.back();
    const double hold_s = goal_distance(goals[ends.size()], arm, level(last.point)).hold_s;
    ends.push_back(last.tick + ticks_of(hold_s, plan.tick_s));
    return ends;
}

}  // namespace downwash::judge
