#include "downwash/problems/goal_reach.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash {
namespace {

constexpr double turn_rad = 2 * std::numbers::pi;
constexpr double rounding_m = 1e-9;

struct Offset {
    double x, z;
};

/// A coordinate's tolerance is tried in steps of at most a quarter of a metre up to this; beyond it trying does not
/// show that there is no pose.
constexpr double widest_m = 2;

/// Offsets within a tolerance: rings around its centre or, where x and z have tolerances of their own, a grid.
std::vector<Offset> offsets_within(const GoalTolerance& tolerance) {
    const auto steps = [](double half_width_m) {
        constexpr double step_m = 0.25;
        return std::clamp(static_cast<int>(std::ceil(half_width_m / step_m)), 2, static_cast<int>(widest_m / step_m));
    };
    const int nx = steps(tolerance.x_m);
    const int nz = steps(tolerance.z_m);
    std::vector<Offset> offsets{{0, 0}};
    if (tolerance.is_disc) {
        for (int ring = 1; ring <= nx; ++ring) {
            const double radius_m = tolerance.x_m * ring / nx;
            const int places = 8 * ring;
            for (int i = 0; i < places; ++i) {
                const double angle = i * turn_rad / places;
                offsets.push_back({radius_m * std::cos(angle), radius_m * std::sin(angle)});
            }
        }
        return offsets;
    }
    for (int i = -nx; i <= nx; ++i) {
        for (int k = -nz; k <= nz; ++k) {
            offsets.push_back({tolerance.x_m * i / nx, tolerance.z_m * k / nz});
        }
    }
    return offsets;
}

bool is_too_wide_to_try(const GoalTolerance& tolerance) {
    return std::max(tolerance.x_m, tolerance.z_m) > widest_m;
}

/// Angles that the arm can turn to within a tolerance around another, at most half a degree apart, the ends of the
/// tolerance and limits of the arm among them; more than half a turn leaves every angle.
std::vector<double> angles_within(double middle_rad, double tolerance_rad, const ArmParameters& arm) {
    constexpr double step_rad = turn_rad / 720;
    const double max_rad = std::min(tolerance_rad, turn_rad / 2);
    const int steps = static_cast<int>(std::ceil(max_rad / step_rad));
    std::vector<double> angles{middle_rad};
    for (int i = 1; i <= steps; ++i) {
        angles.push_back(middle_rad + max_rad * i / steps);
        angles.push_back(middle_rad - max_rad * i / steps);
    }
    for (const double limit_rad : {arm.lower_limit_rad, arm.upper_limit_rad}) {
        if (arm.is_limited && std::abs(lane::wrap_angle(limit_rad - middle_rad)) <= max_rad) {
            angles.push_back(limit_rad);
        }
    }
    std::erase_if(angles, [&arm](double angle_rad) { return !arm_can_turn_to(arm, angle_rad, 0); });
    return angles;
}

bool is_within(const Bounds& bounds, const Configuration& at) {
    return at[plane::x] >= bounds.x_low_m - rounding_m && at[plane::x] <= bounds.x_high_m + rounding_m &&
           at[plane::z] >= bounds.z_low_m - rounding_m && at[plane::z] <= bounds.z_high_m + rounding_m;
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

double missing_reach_m(const Problem& problem, const EndEffectorGoal& goal, const GoalTolerance& tolerance) {
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

Reach reach_of(const ProblemCheck& check, const Goal& wanted) {
    const Problem& problem = check.problem();
    const ArmParameters& arm = problem.robot.arm;
    const CollisionChecker& checker = check.collisions();
    const GoalTolerance tolerance = tolerance_of(wanted);
    // Where the arm reaches does not depend on the rotors, which may have errors of their own.
    const PlantModel plant = make_plant_model(problem.robot.multirotor, arm, {});
    const std::optional<double> angle_rad = level_arm_rad(wanted);
    const std::vector<double> angles =
        angles_within(angle_rad.value_or(0), angle_rad ? tolerance.usable().angle_rad : turn_rad, arm);
    Reach reach = Reach::none;
    for (const Offset& offset : offsets_within(tolerance.usable())) {
        for (const double arm_rad : angles) {
            const Configuration at = placed_at(wanted, plant, {0, 0, arm_rad}, offset.x, offset.z);
            if (!is_within(problem.bounds, at)) {
                continue;
            }
            if (!checker.is_nearer_than(level_at(at), problem.planner.safety_margin_m)) {
                return Reach::clear;
            }
            reach = Reach::blocked;
        }
    }
    return is_too_wide_to_try(tolerance) ? Reach::clear : reach;
}

}  // namespace downwash
