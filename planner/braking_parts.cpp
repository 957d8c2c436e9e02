#include "downwash/planner/braking_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/controllers/space_axes.hpp"
#include "downwash/planner/world_flights.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/search/search_space.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/space_place.hpp"
#include "downwash/simulation/space_world.hpp"

namespace downwash::planning {
namespace {

constexpr Maneuver planar_maneuvers[] = {{1, 1.3, 0},   {2, 1.2, 0}, {1, 1.3, -0.3}, {1, 1.3, 0.3},  {2, 1.2, -0.3},
                                         {2, 1.2, 0.3}, {3, 1.1, 0}, {2, 2.5, 0},    {2, 1.2, -0.8}, {2, 1.2, 0.8}};
constexpr Maneuver space_maneuvers[] = {{1, 1.3, 0},      {2, 1.2, 0},   {1, 1.3, -0.3}, {1, 1.3, 0.3},
                                        {2, 1.2, -0.3},   {2, 1.2, 0.3}, {3, 1.1, 0},    {2, 1.2, 0, -0.4},
                                        {2, 1.2, 0, 0.4}, {2, 2.5, 0},   {2, 1.2, -0.8}, {2, 1.2, 0.8}};

/// Beside its rest, in which a hover still counts.
constexpr double hover_tolerance_m = 0.3, hover_tolerance_rad = 0.35;

}  // namespace

FlightState begun_in(FlightState vehicle, const FlownWorld* world) {
    vehicle.world = memory_at_start(*world, vehicle.plant);
    return vehicle;
}

AnySpaceState begun_in(AnySpaceState vehicle, const SpaceWorld* world) {
    vehicle.world = {};
    for (auto& past : vehicle.world.past) {
        std::ranges::copy(vehicle.plant.q, past.q);
        std::ranges::copy(vehicle.plant.u, past.u);
    }
    if (world != nullptr && (world->position_noise_m > 0 || world->velocity_noise_m_s > 0 ||
                             world->gyro_noise_rad_s > 0 || world->gust_m_s > 0)) {
        simulation::start_gusts(world->tape, vehicle.world.gust);
    }
    return vehicle;
}

// The plane.

BrakingPartsOf<Plane>::BrakingPartsOf(const Problem& problem, const FlightModel& model, MapAround map_around,
                                      int threads)
    : problem_(problem), model_(model), map_around_(std::move(map_around)), threads_(threads) {}

std::span<const Maneuver> BrakingPartsOf<Plane>::maneuvers() noexcept {
    return planar_maneuvers;
}

MotionLimits BrakingPartsOf<Plane>::limits_of(const Maneuver& maneuver) const {
    MotionLimits limits = problem_.motion;
    limits.max_speed_m_s *= 2;  // a vehicle is as fast as it is
    limits.max_arm_rate_rad_s *= 2;
    limits.max_acceleration_m_s2 *= maneuver.harder;
    limits.max_arm_acceleration_rad_s2 *= maneuver.harder;
    limits.max_jerk_m_s3 *= maneuver.harder;
    return limits;
}

Configuration BrakingPartsOf<Plane>::rest_of(const ReferencePoint& from, const MotionLimits& limits,
                                             const Maneuver& maneuver) const {
    const std::span<const Axis> axes = problem_.axes();
    const double speed_m_s = std::hypot(from.velocity[plane::x], from.velocity[plane::z]);
    const MotionLimits straight = limits_along(limits, from.velocity);
    Configuration rest;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const double rate = axes[i].group == AxisGroup::translation ? speed_m_s : std::abs(from.velocity[i]);
        const double time_s = maneuver.farther * rate / max_acceleration(straight, axes[i].group);
        rest[i] = from.position[i] + 0.5 * time_s * from.velocity[i];
    }
    rest[plane::z] += maneuver.up_m;
    return rest;
}

bool BrakingPartsOf<Plane>::is_inside(const Configuration& at) const {
    const Bounds& bounds = problem_.bounds;
    return at[plane::x] >= bounds.x_low_m && at[plane::x] <= bounds.x_high_m && at[plane::z] >= bounds.z_low_m &&
           at[plane::z] <= bounds.z_high_m;
}

bool BrakingPartsOf<Plane>::is_nearer_than(const Configuration& at, double margin_m) const {
    return model_.collisions().clearance_m(level_at(at)) < margin_m;
}

double BrakingPartsOf<Plane>::kept_margin_m(const FlightState& vehicle) const {
    const double here_m = model_.collisions().clearance_m(pose_of(vehicle));
    return std::min(problem_.planner.safety_margin_m, here_m - ClearanceError{}.at_m(here_m));
}

Configuration BrakingPartsOf<Plane>::place_of(const FlightState& vehicle) const {
    return configuration_of(vehicle.plant.q);
}

Goal BrakingPartsOf<Plane>::hover_at(const Configuration& rest) const {
    Goal goal;
    goal.kind =
        ConfigurationGoal{rest[plane::x], rest[plane::z], rest[plane::arm], hover_tolerance_m, hover_tolerance_rad};
    goal.hold_s = stop_hold_s;
    return goal;
}

Plan BrakingPartsOf<Plane>::with_hover(const Plan& plan, const Hover& hover) const {
    return downwash::with_hover(plan, hover, model_);
}

void BrakingPartsOf<Plane>::judge(FlightJob& job, const Hover& hover, double /*margin_m*/) const {
    job.judged_ticks = std::llround(goal_settling_s / model_.tick().tick_s);
    job.goal = &hover;
}

/// Those between the places, and around them. Rests are within the bounds, wherever the vehicle is.
void BrakingPartsOf<Plane>::fly_around(std::span<const Configuration> places) {
    constexpr double swing_m = 0.3;
    const auto between = [&](std::size_t axis, double low_m, double high_m) {
        const auto [least, most] = std::ranges::minmax_element(
            places, [axis](const Configuration& a, const Configuration& b) { return a[axis] < b[axis]; });
        return std::pair{std::clamp((*least)[axis], low_m, high_m) - swing_m,
                         std::clamp((*most)[axis], low_m, high_m) + swing_m};
    };
    const Bounds& bounds = problem_.bounds;
    const auto [x_low_m, x_high_m] = between(plane::x, bounds.x_low_m, bounds.x_high_m);
    const auto [z_low_m, z_high_m] = between(plane::z, bounds.z_low_m, bounds.z_high_m);
    std::shared_ptr<const AeroMap> map = map_around_({x_low_m, x_high_m, z_low_m, z_high_m});
    if (!pool_ || map != map_) {
        map_ = std::move(map);
        FlightRules rules = rules_of_execution();
        rules.finds_min_clearance = ClearanceError{};
        pool_ = std::make_unique<FlightPool>(model_, map_.get(), rules, nullptr, threads_);
    }
}

bool BrakingPartsOf<Plane>::fails(const FlightJob& job, bool is_nominal, double margin_m) {
    const Rejection rejection = job.rejection();
    return is_nominal ? rejection != Rejection::none || min_clearance_m(job) < margin_m
                      : rejection != Rejection::none && rejection != Rejection::goal_missed;
}

// Space.

BrakingPartsOf<Space>::BrakingPartsOf(const SpaceProblem& problem, const SpaceProblemModel& model, MapAround map_around,
                                      int threads)
    : problem_(problem), model_(model), map_around_(std::move(map_around)), threads_(threads) {}

std::span<const Maneuver> BrakingPartsOf<Space>::maneuvers() noexcept {
    return space_maneuvers;
}

SpaceMotionLimits BrakingPartsOf<Space>::limits_of(const Maneuver& maneuver) const {
    SpaceMotionLimits limits = motion_limits_of(problem_);
    limits.max_speed_m_s *= 2;  // a vehicle is as fast as it is
    limits.max_yaw_rate_rad_s *= 2;
    limits.max_acceleration_m_s2 *= maneuver.harder;
    limits.max_jerk_m_s3 *= maneuver.harder;
    limits.max_yaw_acceleration_rad_s2 *= maneuver.harder;
    for (std::size_t i = 0; i < max_joints; ++i) {
        limits.max_joint_rate_rad_s[i] *= 2;
        limits.max_joint_acceleration_rad_s2[i] *= maneuver.harder;
    }
    return limits;
}

SpaceConfiguration BrakingPartsOf<Space>::rest_of(const SpacePoint& from, const SpaceMotionLimits& limits,
                                                  const Maneuver& maneuver) const {
    const double(&v)[space_axes<max_joints>] = from.velocity;
    const double level_m_s = std::hypot(v[space::x], v[space::y]);
    const double speed_m_s = std::hypot(level_m_s, v[space::z]);
    const SpaceMotionLimits straight = limits_along(limits, v);
    const int axes = space::first_joint + problem_.robot.joints();
    SpaceConfiguration rest;
    for (int axis = 0; axis < axes; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        const double rate = axis < space::yaw ? speed_m_s : std::abs(v[i]);
        const double time_s = maneuver.farther * rate / max_acceleration(straight, axis);
        rest[i] = from.position[i] + 0.5 * time_s * v[i];
        if (axis >= space::first_joint) {
            const SpaceLinkLimits& link = problem_.robot.links[i - space::first_joint];
            rest[i] = link.is_limited ? std::clamp(rest[i], link.lower_limit_rad, link.upper_limit_rad) : rest[i];
        }
    }
    rest[space::z] += maneuver.up_m;
    // What rises or hovers has no side; its nose has.
    const bool has_way = level_m_s > 1e-3;
    const double yaw = from.position[space::yaw];
    rest[space::x] -= maneuver.left_m * (has_way ? v[space::y] / level_m_s : std::sin(yaw));
    rest[space::y] += maneuver.left_m * (has_way ? v[space::x] / level_m_s : std::cos(yaw));
    return rest;
}

bool BrakingPartsOf<Space>::is_inside(const SpaceConfiguration& at) const {
    const auto& [low_m, high_m] = problem_.bounds;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(at[i] >= low_m[i] && at[i] <= high_m[i])) {
            return false;
        }
    }
    return true;
}

bool BrakingPartsOf<Space>::is_nearer_than(const SpaceConfiguration& at, double margin_m) const {
    return model_.collisions().is_nearer_than(level_at(at), std::max(0.0, margin_m));
}

double BrakingPartsOf<Space>::kept_margin_m(const AnySpaceState& vehicle) const {
    const double error_m = model_.collisions().kind() == CollisionCheckerKind::own ? 1e-6 : 0.002;
    const double margin_m = problem_.planner.safety_margin_m;
    const SpacePose pose = among_obstacles(motion_of(vehicle), {});
    return std::clamp(model_.collisions().clearance_m(pose, margin_m + 2 * error_m) - error_m, 0.0, margin_m);
}

SpaceConfiguration BrakingPartsOf<Space>::place_of(const AnySpaceState& vehicle) const {
    return configuration_of(motion_of(vehicle));
}

std::shared_ptr<const SpaceGoalRule> BrakingPartsOf<Space>::hover_at(const SpaceConfiguration& rest) const {
    SpaceConfigurationGoal at;
    at.x_m = rest[space::x];
    at.y_m = rest[space::y];
    at.z_m = rest[space::z];
    at.yaw_rad = rest[space::yaw];
    at.joints_rad.assign(rest.begin() + space::first_joint,
                         rest.begin() + space::first_joint + problem_.robot.joints());
    at.tolerance_m = hover_tolerance_m;
    at.tolerance_rad = hover_tolerance_rad;
    return std::make_shared<const SpaceGoalRule>(problem_.robot, model_.shared_scene(),
                                                 std::vector{SpaceGoal{at, stop_hold_s}});
}

SpacePlan BrakingPartsOf<Space>::with_hover(const SpacePlan& plan, const Hover& /*hover*/) const {
    return plan.held_for(std::llround(stop_hold_s / plan.tick_s));
}

void BrakingPartsOf<Space>::judge(SpaceFlightJob& job, const Hover& hover, double margin_m) const {
    job.judged_ticks = std::llround(goal_settling_s * problem_.robot.controller.rate_hz);
    job.goal = hover.get();
    job.margin_m = std::max(0.0, margin_m);
}

void BrakingPartsOf<Space>::fly_around(std::span<const SpaceConfiguration> /*places*/) {
    if (pool_) {
        return;
    }
    map_ = map_around_();
    SpacePoolSetup setup{model_.problem().robot};
    if (map_ != nullptr) {
        setup.aero = simulation::space_aero(problem_.aero, problem_.robot.rotor_radius_m);
        setup.volumes = map_.get();
    }
    setup.checker = &model_.collisions();
    pool_ = std::make_unique<SpacePool>(setup, threads_);
}

/// Its own margin is a rule of the flight.
bool BrakingPartsOf<Space>::fails(const SpaceFlightJob& job, bool is_nominal, double /*margin_m*/) {
    const Rejection rejection = job.rejection();
    return rejection != Rejection::none && (is_nominal || rejection != Rejection::goal_missed);
}

}  // namespace downwash::planning
