#include "downwash/planner/goal_reach.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

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

/// Offsets within a tolerance: its centre, then points half way and near its rim, or, where x and z have tolerances of
/// their own, a grid, its points at most a quarter of a metre apart up to a tolerance of two metres.
std::vector<Offset> offsets_within(const GoalTolerance& tolerance) {
    std::vector<Offset> offsets{{0, 0}};
    if (tolerance.is_disc) {
        for (int i = 0; i < 8; ++i) {
            const double angle = i * turn_rad / 8;
            for (const double share : {0.5, usable_tolerance_share}) {
                offsets.push_back({share * tolerance.x_m * std::cos(angle), share * tolerance.z_m * std::sin(angle)});
            }
        }
        return offsets;
    }
    const auto steps = [](double half_width_m) {
        return std::clamp(static_cast<int>(std::ceil(half_width_m / 0.25)), 2, 8);
    };
    const int nx = steps(tolerance.x_m);
    const int nz = steps(tolerance.z_m);
    for (int i = -nx; i <= nx; ++i) {
        for (int k = -nz; k <= nz; ++k) {
            offsets.push_back(
                {usable_tolerance_share * tolerance.x_m * i / nx, usable_tolerance_share * tolerance.z_m * k / nz});
        }
    }
    return offsets;
}

/// Whether a tolerance of the coordinates is so wide that trying does not show that there is no pose.
bool is_too_wide_to_try(const GoalTolerance& tolerance) {
    constexpr double widest_m = 2;
    return !tolerance.is_disc && std::max(tolerance.x_m, tolerance.z_m) > widest_m;
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

double missing_reach_m(const Problem& problem, const Goal& wanted) {
    const EndEffectorGoal& goal = *wanted.end_effector;
    const GoalTolerance tolerance = tolerance_of(wanted);
    const ArmParameters& arm = problem.robot.arm;
    const Bounds& bounds = problem.bounds;
    // The vehicle's place if the arm had no length; a level vehicle carries its joint at a fixed offset.
    const double x_m = goal.x_m - arm.joint_x_m;
    const double z_m = goal.z_m - arm.joint_z_m;
    // A rectangle of places widens the bounds, as they are one; a disc lengthens the arm.
    const double wider_x_m = tolerance.is_disc ? 0 : tolerance.x_m;
    const double wider_z_m = tolerance.is_disc ? 0 : tolerance.z_m;
    const double longer_m = tolerance.is_disc ? tolerance.x_m : 0;
    const double low_x = bounds.x_low_m - wider_x_m, high_x = bounds.x_high_m + wider_x_m;
    const double low_z = bounds.z_low_m - wider_z_m, high_z = bounds.z_high_m + wider_z_m;
    const double nearest_m = std::hypot(x_m - std::clamp(x_m, low_x, high_x), z_m - std::clamp(z_m, low_z, high_z));
    const double farthest_m = std::hypot(std::max(std::abs(x_m - low_x), std::abs(x_m - high_x)),
                                         std::max(std::abs(z_m - low_z), std::abs(z_m - high_z)));
    const double too_far_m = nearest_m - (arm.length_m + longer_m);
    const double too_near_m = (arm.length_m - longer_m) - farthest_m;
    return std::max(too_far_m, too_near_m);
}

Reach reach_of_end_effector(const Problem& problem, const Goal& wanted) {
    const EndEffectorGoal& goal = *wanted.end_effector;
    const ArmParameters& arm = problem.robot.arm;
    const CollisionChecker checker = checker_of(problem);
    const std::vector<Offset> offsets = offsets_within(tolerance_of(wanted));
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
        for (const Offset& offset : offsets) {
            const double x_m = goal.x_m + offset.x - arm.length_m * std::cos(angle_rad) - arm.joint_x_m;
            const double z_m = goal.z_m + offset.z + arm.length_m * std::sin(angle_rad) - arm.joint_z_m;
            if (!is_within(problem.bounds, x_m, z_m)) {
                continue;
            }
            if (!checker.is_nearer_than({x_m, z_m, 0, angle_rad}, problem.planner.safety_margin_m)) {
                return Reach::clear;
            }
            reach = Reach::blocked;
        }
    }
    return is_too_wide_to_try(tolerance_of(wanted)) ? Reach::clear : reach;
}

bool has_clear_configuration(const Problem& problem, const Goal& wanted) {
    const ConfigurationGoal& goal = *wanted.configuration;
    const GoalTolerance tolerance = tolerance_of(wanted);
    if (!goal.x_m || !goal.z_m || !goal.arm_rad || is_too_wide_to_try(tolerance)) {
        return true;
    }
    const CollisionChecker checker = checker_of(problem);
    for (const Offset& offset : offsets_within(tolerance)) {
        for (const double turned : {0.0, -0.5, 0.5, -usable_tolerance_share, usable_tolerance_share}) {
            const PlanarPose pose{*goal.x_m + offset.x, *goal.z_m + offset.z, 0,
                                  *goal.arm_rad + goal.tolerance_rad * turned};
            if (!checker.is_nearer_than(pose, problem.planner.safety_margin_m)) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace downwash
