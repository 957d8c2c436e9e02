#include "downwash/search/space_search_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "downwash/base/infinity.hpp"
#include "downwash/controllers/space_duration.hpp"
#include "downwash/scene/space_motion.hpp"
#include "downwash/search/obstacle_labels.hpp"
#include "downwash/simulation/space_pool.hpp"
#include "downwash/simulation/space_tool.hpp"

namespace downwash::planning {
namespace {

std::vector<SearchAxis> search_axes(const SpaceProblem& problem, double reach_m) {
    const SpaceMotionLimits& motion = problem.motion;
    const auto axis = [&](AxisGroup group, double low, double high, double axis_reach_m, bool wraps, int number) {
        const double weight_m = group == AxisGroup::translation ? 1 : 0.5 * axis_reach_m;
        return SearchAxis{group,
                          low,
                          high,
                          weight_m,
                          wraps,
                          axis_reach_m,
                          max_rate(motion, number),
                          max_acceleration(motion, number)};
    };
    std::vector<SearchAxis> axes;
    for (std::size_t i = 0; i < 3; ++i) {
        axes.push_back(axis(AxisGroup::translation, problem.bounds.low_m[i], problem.bounds.high_m[i], 1, false,
                            static_cast<int>(i)));
    }
    axes.push_back(axis(AxisGroup::yaw, -std::numbers::pi, std::numbers::pi, reach_m, true, space::yaw));
    for (std::size_t i = 0; i < problem.robot.links.size(); ++i) {
        const SpaceLinkLimits& link = problem.robot.links[i];
        axes.push_back(axis(AxisGroup::joint, link.is_limited ? link.lower_limit_rad : -std::numbers::pi,
                            link.is_limited ? link.upper_limit_rad : std::numbers::pi, reach_m, !link.is_limited,
                            space::first_joint + static_cast<int>(i)));
    }
    return axes;
}

/// How far the end effector gets from the multirotor's centre of mass at most [m].
double tool_reach_m(const SpaceRobot& robot) {
    const auto length_m = [](const Vector3& v) { return std::sqrt(dot(v, v)); };
    double reach_m = length_m(robot.plant.end_effector_m);
    for (const auto& link : robot.plant.links) {
        reach_m += length_m(link.joint_m);
    }
    return reach_m;
}

/// A ball in which a goal wants the end effector; empty if it does not say.
struct WantedBall {
    Vector3 center_m;
    double radius_m;
};
std::optional<WantedBall> wanted_ball(const SpaceGoalKind& kind) {
    if (const auto* tool = std::get_if<SpaceEndEffectorGoal>(&kind)) {
        return WantedBall{tool->position_m, tool->tolerance_m};
    }
    if (const auto* pose = std::get_if<SpacePoseGoal>(&kind)) {
        return WantedBall{pose->position_m, pose->tolerance_m};
    }
    if (const auto* camera = std::get_if<SpaceCameraGoal>(&kind)) {
        return WantedBall{camera->target_m, camera->farthest_m};
    }
    return std::nullopt;
}

/// What a reference may use of the goal's tolerances, and rounding.
constexpr double near_goal_share = usable_tolerance_share + 1e-6;

/// What share of the goal's tolerances a vehicle at a configuration uses when it is 5 cm off its place and 3 degrees
/// off its yaw and every joint, about as much as in worlds: to first order, each in its worse direction.
double used_share_when_off(const SpaceConfiguration& at, const SpaceSearchSpace& space) {
    constexpr double off_m = 0.05, off_rad = 0.05;
    const double there = space.error(at).used_share;
    const auto more = [&](std::size_t axis, double off) {
        double most = 0;
        for (const double by : {off, -off}) {
            SpaceConfiguration beside = at;
            beside[axis] += by;
            const SpaceGoalError error = space.error(beside);
            most = std::max(most, error.is_hidden ? 1 : error.used_share - there);
        }
        return most;
    };
    double used = there + std::max({more(0, off_m), more(1, off_m), more(2, off_m)});
    for (std::size_t axis = space::yaw; axis < space.axes().size(); ++axis) {
        used += more(axis, off_rad);
    }
    return used;
}

/// How well a configuration in the goal region suits vehicles in worlds: 1 where it is clear of obstacles by two rotor
/// radii, where surfaces do not act much on rotors any more, and where the goal is met by a vehicle that is somewhat
/// off; less where it is nearer or the goal is missed then.
double ease_at(const SpaceConfiguration& at, const SpaceSearchSpace& space, const SpaceProblemModel& model) {
    const double enough_m = 2 * model.problem().robot.rotor_radius_m;
    const double room = model.collisions().clearance_m(level_at(at), enough_m) / enough_m;
    return room - std::max(0.0, used_share_when_off(at, space) - 1);
}

std::span<const SpaceGoal> alternatives(const SpaceGoal& goal) noexcept {
    return goal.any_of.empty() ? std::span(&goal, 1) : std::span(goal.any_of);
}

}  // namespace

SpaceSearchSpace::SpaceSearchSpace(const SpaceProblem& problem, const SpaceProblemModel& model)
    : SearchAxesOf<Space>(search_axes(problem, model.collisions().robot_reach_m())),
      model_(model),
      rule_(problem.robot, model.shared_scene(), {problem.goals.front()}),
      sampler_(problem.robot, problem.bounds, model.shared_scene(), model.collisions(), problem.planner.safety_margin_m,
               problem.goals.front()),
      yaw_(problem.motion.yaw, model.problem().robot, rule_),
      limits_(motion_limits_of(problem)),
      start_(place_of(problem.start)),
      margin_m_(problem.planner.safety_margin_m),
      reach_m_(model.collisions().robot_reach_m()),
      tool_reach_m_(tool_reach_m(problem.robot)) {}

double SpaceSearchSpace::duration_s(const Configuration& from, const Configuration& to) const noexcept {
    double along[space_axes<max_joints>] = {};
    for (std::size_t i = 0; i < axes().size(); ++i) {
        along[i] = way(i, from[i], to[i]);
    }
    return rest_to_rest_duration_s(along, limits_along(limits_, along));
}

double SpaceSearchSpace::duration_at_limits_s(const Configuration& from, const Configuration& to) const noexcept {
    double longest_s = travel_m(from, to) / limits_.max_speed_m_s;
    for (std::size_t i = space::yaw; i < axes().size(); ++i) {
        longest_s = std::max(longest_s, std::abs(way(i, from[i], to[i])) / axes()[i].max_rate);
    }
    return longest_s;
}

double SpaceSearchSpace::distance_m(const Configuration& a, const Configuration& b) const noexcept {
    return duration_s(a, b) * limits_.max_speed_m_s / peak_over_mean_speed;
}

double SpaceSearchSpace::squared_distance_m2(const Configuration& a, const Configuration& b,
                                             double /*enough_m2*/) const noexcept {
    const double distance = distance_m(a, b);
    return distance * distance;
}

SpaceConfiguration SpaceSearchSpace::steered(const Configuration& from, const Configuration& to, double range_m) const {
    const Configuration target = seen_from(from, to);
    const double distance = distance_m(from, target);
    return distance <= range_m ? target : between(from, target, range_m / distance);
}

SpaceConfiguration SpaceSearchSpace::sample_in_transport(Random& random) const {
    Configuration c = sample(random);
    std::copy(start_.begin() + space::first_joint, start_.end(), c.begin() + space::first_joint);
    return c;
}

/// Half of the samples aim at the goal itself, the others anywhere in the usable part of its tolerances; worlds leave
/// less of that. Where nothing is free so near to the middle, samples come from farther and farther out.
std::optional<SpaceConfiguration> SpaceSearchSpace::drawn_at_goal(Random& random) const {
    constexpr int widenings = 3, tries = 25;
    const double usable = model_.problem().uncertainty ? 0.5 * usable_tolerance_share : usable_tolerance_share;
    const double share = random.chance(0.5) ? 0 : usable * random.uniform(0, 1);
    for (int i = 0; i <= widenings; ++i) {
        const double wider = share + (usable_tolerance_share - share) * i / widenings;
        if (const SpaceGoalSample drawn = sampler_.sample(random, wider, tries); drawn.place) {
            return drawn.place->at;
        }
    }
    return std::nullopt;
}

std::optional<SpaceConfiguration> SpaceSearchSpace::sample_goal(Random& random) const {
    std::optional<Configuration> best = drawn_at_goal(random);
    if (!best || !model_.problem().uncertainty) {
        return best;
    }
    // In worlds neither obstacles nor vehicles are where they should be. Of some samples the one that bears most of
    // that is good in most of them.
    constexpr int samples = 4;
    double most = ease_at(*best, *this, model_);
    for (int i = 1; i < samples && most < 1; ++i) {
        const std::optional<Configuration> other = drawn_at_goal(random);
        const double ease = other ? ease_at(*other, *this, model_) : -infinity;
        if (ease > most) {
            best = other;
            most = ease;
        }
    }
    return best;
}

std::optional<SpaceConfiguration> SpaceSearchSpace::nearest_at_goal(const Configuration& to, double share,
                                                                    bool may_have_flaws) const {
    const auto metric = [this](const Configuration& a, const Configuration& b) { return distance_m(a, b); };
    const std::optional<SpaceGoalPlace> place = sampler_.nearest(to, metric, share);
    if (!place || (!may_have_flaws && sampler_.flaw(*place) != SpaceGoalFlaw::none)) {
        return std::nullopt;
    }
    return place->at;
}

std::optional<SpaceConfiguration> SpaceSearchSpace::sample_goal_near(const Configuration& configuration,
                                                                     double radius_m, Random& random) const {
    const Configuration near = sample_near(configuration, radius_m, random);
    return nearest_at_goal(near, usable_tolerance_share * random.uniform(0, 1), false);
}

SpaceConfiguration SpaceSearchSpace::moved_into_goal(Configuration c, double share) const {
    return nearest_at_goal(c, share, true).value_or(c);
}

SpaceGoalError SpaceSearchSpace::error(const Configuration& c) const {
    return rule_.error_at(0, c);
}

std::int64_t SpaceSearchSpace::hold_ticks(const SpacePoint& at) const {
    const SpacePlan plan{{{0, at}}, 1 / model_.problem().robot.controller.rate_hz, model_.problem().robot.joints()};
    return rule_.hovers(plan).front().end_tick;
}

double SpaceSearchSpace::hold_s(const Configuration& c) const {
    return static_cast<double>(hold_ticks(at_rest(c))) / model_.problem().robot.controller.rate_hz;
}

bool SpaceSearchSpace::is_near_goal(const Configuration& c) const {
    const SpaceGoalError off = error(c);
    return off.used_share <= near_goal_share && !off.is_hidden;
}

SpacePoint SpaceSearchSpace::looking(const SpacePoint& before, const SpacePoint& point) const {
    return yaw_.looking(before, point, near_goal_share);
}

double SpaceSearchSpace::goal_distance_m(const Configuration& c) const {
    if (is_near_goal(c)) {
        return 0;
    }
    const SpaceGoalError off = error(c);
    constexpr double unknown_turn_rad = 1;  // to where a surface could be touched
    return off.distance_m + 0.5 * reach_m_ * (std::isfinite(off.used_share) ? off.angle_rad : unknown_turn_rad);
}

bool SpaceSearchSpace::is_met(const AnySpaceState& vehicle) const {
    const SpaceMotion motion = motion_of(vehicle);
    return meets_goal(rule_.error(rule_.hover_at(0, at_rest(configuration_of(motion))), motion), motion);
}

std::vector<SpaceSearchSpace::Approach> SpaceSearchSpace::approaches(const Configuration& from) const {
    // No point of the robot is faster than the vehicle, and turns it and every joint about a point within its reach.
    double tool_speed_m_s = limits_.max_speed_m_s;
    for (std::size_t i = space::yaw; i < axes().size(); ++i) {
        tool_speed_m_s += 2 * reach_m_ * axes()[i].max_rate;
    }
    std::vector<Approach> all;
    const std::vector<SpaceGoalError> errors = rule_.errors_at(0, from);
    for (const SpaceGoal& goal : alternatives(this->goal())) {
        const SpaceGoalError& off = errors[all.size()];
        if (const auto* at = std::get_if<SpaceConfigurationGoal>(&goal.kind)) {
            const double way_m = std::max(0.0, off.distance_m - at->tolerance_m);
            double longest_s = way_m / limits_.max_speed_m_s;
            if (at->yaw_rad) {
                const double turn_rad = std::abs(way(space::yaw, from[space::yaw], *at->yaw_rad)) - at->tolerance_rad;
                longest_s = std::max(longest_s, turn_rad / limits_.max_yaw_rate_rad_s);
            }
            for (std::size_t i = 0; i < at->joints_rad.size(); ++i) {
                const std::size_t axis = space::first_joint + i;
                const double turn_rad = std::abs(way(axis, from[axis], at->joints_rad[i])) - at->tolerance_rad;
                longest_s = std::max(longest_s, turn_rad / axes()[axis].max_rate);
            }
            all.push_back({way_m, longest_s, goal.hold_s});
            continue;
        }
        const std::optional<WantedBall> ball = wanted_ball(goal.kind);
        const bool is_camera = std::holds_alternative<SpaceCameraGoal>(goal.kind);  // its error is beyond its distances
        const auto* const contact = std::get_if<SpaceContactGoal>(&goal.kind);
        const double tolerance_m = contact != nullptr ? contact->tolerance_m : ball && !is_camera ? ball->radius_m : 0;
        const double tool_way_m = std::max(0.0, off.distance_m - tolerance_m);
        double way_m = 0;
        if (ball) {
            const Vector3 to_m = ball->center_m - Vector3{from[0], from[1], from[2]};
            way_m = std::max(0.0, std::sqrt(dot(to_m, to_m)) - ball->radius_m - tool_reach_m_);
        }
        // A touch itself is no part of the plan.
        const double hold_s = contact != nullptr ? touch_hover_s : goal.hold_s;
        all.push_back({way_m, std::max(tool_way_m / tool_speed_m_s, way_m / limits_.max_speed_m_s), hold_s});
    }
    return all;
}

Rejection SpaceSearchSpace::rejection_at(const Configuration& c, const SpacePose& pose) const {
    if (const Rejection left = limit_left_at(c); left != Rejection::none) {
        return left;
    }
    return model_.collisions().is_nearer_than(pose, margin_m_) ? Rejection::collision : Rejection::none;
}

bool SpaceSearchSpace::has_room(const Configuration& c, double more_m) const {
    return limit_left_at(c) == Rejection::none && !model_.collisions().is_nearer_than(level_at(c), margin_m_ + more_m);
}

bool SpaceSearchSpace::is_allowed(const Configuration& c, QueryCounts& counts) const {
    const Rejection rejection = rejection_at(c);
    if (rejection == Rejection::collision) {
        count_collision(model_, level_at(c), margin_m_, counts.stopped_by);
    }
    return counts.note(rejection);
}

SpacePose SpaceSearchSpace::pose_along(const SpacePoint& point, bool tilts) const {
    SpacePose pose = level_at(configuration_of(point));
    if (!tilts) {
        return pose;
    }
    // The shortest turn from the vertical to a + g, after the heading.
    Vector3 force{point.acceleration[0], point.acceleration[1], point.acceleration[2] + standard_gravity_m_s2};
    const double length = std::sqrt(dot(force, force));
    if (!(length > 0)) {
        return pose;
    }
    force = (1 / length) * force;
    const std::array<double, 4> tilt = normalised({1 + force[2], -force[1], force[0], 0});
    const double c = pose.attitude[0], s = pose.attitude[3];
    if (force[2] > -1) {
        pose.attitude = {tilt[0] * c, tilt[1] * c + tilt[2] * s, tilt[2] * c - tilt[1] * s, tilt[0] * s};
    }
    return pose;
}

double SpaceSearchSpace::extent_m() const noexcept {
    Configuration low{}, high{};
    for (std::size_t i = 0; i < axes().size(); ++i) {
        low[i] = axes()[i].wraps ? 0 : axes()[i].low;
        high[i] = axes()[i].wraps ? std::numbers::pi : axes()[i].high;
    }
    return distance_m(low, high);
}

}  // namespace downwash::planning
