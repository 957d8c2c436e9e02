#include "downwash/planner/goal_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "downwash/base/lane_math.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash {
namespace {

constexpr double turn_rad = 2 * std::numbers::pi;
constexpr int arm_angles = 720;
constexpr double rounding_m = 1e-9;

struct Offset {
    double x, z;
};

/// A disc of radius one, sampled: its centre, and points near its rim and half way.
std::array<Offset, 17> unit_disc() {
    std::array<Offset, 17> offsets{};
    for (std::size_t i = 0; i < 8; ++i) {
        const double angle = static_cast<double>(i) * turn_rad / 8;
        offsets[1 + i] = {0.5 * std::cos(angle), 0.5 * std::sin(angle)};
        offsets[9 + i] = {usable_tolerance_share * std::cos(angle), usable_tolerance_share * std::sin(angle)};
    }
    return offsets;
}

bool is_within(const Bounds& bounds, double x_m, double z_m) {
    return x_m >= bounds.x_low_m - rounding_m && x_m <= bounds.x_high_m + rounding_m &&
           z_m >= bounds.z_low_m - rounding_m && z_m <= bounds.z_high_m + rounding_m;
}

CollisionChecker checker_of(const Problem& problem) {
    return {std::make_shared<const Scene>(problem.obstacles), problem.plane, problem.robot.shape()};
}

}  // namespace

bool arm_can_turn_to(const ArmParameters& arm, double angle_rad, double tolerance_rad) {
    if (!arm.is_limited) {
        return true;
    }
    const double middle = (arm.lower_limit_rad + arm.upper_limit_rad) / 2;
    const double half_range = (arm.upper_limit_rad - arm.lower_limit_rad) / 2;
    return std::abs(lane::wrap_angle(angle_rad - middle)) <= half_range + tolerance_rad + rounding_m;
}

double missing_reach_m(const Problem& problem) {
    const EndEffectorGoal& goal = *problem.goal.end_effector;
    const ArmParameters& arm = problem.robot.arm;
    const Bounds& bounds = problem.bounds;
    // The vehicle's place if the arm had no length; a level vehicle carries its joint at a fixed offset.
    const double x_m = goal.x_m - arm.joint_x_m;
    const double z_m = goal.z_m - arm.joint_z_m;
    const double nearest_m = std::hypot(x_m - std::clamp(x_m, bounds.x_low_m, bounds.x_high_m),
                                        z_m - std::clamp(z_m, bounds.z_low_m, bounds.z_high_m));
    const double farthest_m = std::hypot(std::max(std::abs(x_m - bounds.x_low_m), std::abs(x_m - bounds.x_high_m)),
                                         std::max(std::abs(z_m - bounds.z_low_m), std::abs(z_m - bounds.z_high_m)));
    const double too_far_m = nearest_m - (arm.length_m + goal.tolerance_m);
    const double too_near_m = (arm.length_m - goal.tolerance_m) - farthest_m;
    return std::max(too_far_m, too_near_m);
}

Reach reach_of_end_effector(const Problem& problem) {
    const EndEffectorGoal& goal = *problem.goal.end_effector;
    const ArmParameters& arm = problem.robot.arm;
    const CollisionChecker checker = checker_of(problem);
    const auto disc = unit_disc();
    Reach reach = Reach::none;
    for (int k = 0; k < arm_angles; ++k) {
        // Counted from the wanted direction, so that this one is tried whatever it is.
        const double angle_rad = goal.direction_rad.value_or(0) + k * turn_rad / arm_angles;
        const bool is_direction_right =
            !goal.direction_rad ||
            std::abs(lane::wrap_angle(angle_rad - *goal.direction_rad)) <= goal.direction_tolerance_rad;
        if (!is_direction_right || !arm_can_turn_to(arm, angle_rad, 0)) {
            continue;
        }
        for (const Offset& offset : disc) {
            const double x_m =
                goal.x_m + goal.tolerance_m * offset.x - arm.length_m * std::cos(angle_rad) - arm.joint_x_m;
            const double z_m =
                goal.z_m + goal.tolerance_m * offset.z + arm.length_m * std::sin(angle_rad) - arm.joint_z_m;
            if (!is_within(problem.bounds, x_m, z_m)) {
                continue;
            }
            if (!checker.is_nearer_than({x_m, z_m, 0, angle_rad}, problem.planner.safety_margin_m)) {
                return Reach::clear;
            }
            reach = Reach::blocked;
        }
    }
    return reach;
}

bool has_clear_configuration(const Problem& problem) {
    const ConfigurationGoal& goal = *problem.goal.configuration;
    if (!goal.x_m || !goal.z_m || !goal.arm_rad) {
        return true;
    }
    const CollisionChecker checker = checker_of(problem);
    for (const Offset& offset : unit_disc()) {
        for (const double turned : {0.0, -0.5, 0.5, -usable_tolerance_share, usable_tolerance_share}) {
            const PlanarPose pose{*goal.x_m + goal.tolerance_m * offset.x, *goal.z_m + goal.tolerance_m * offset.z, 0,
                                  *goal.arm_rad + goal.tolerance_rad * turned};
            if (!checker.is_nearer_than(pose, problem.planner.safety_margin_m)) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace downwash
