#include "downwash/search/search_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "downwash/base/lane_math.hpp"
#include "downwash/search/obstacle_labels.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {

ReferencePoint reference_at(const Start& start) noexcept {
    if (start.reference) {
        return *start.reference;
    }
    ReferencePoint point = at_rest(start.at);
    std::ranges::copy(start.velocity, point.velocity);
    return point;
}

namespace {

std::vector<SearchAxis> search_axes(const Bounds& bounds, const ArmParameters& arm, const MotionLimits& motion) {
    const bool wraps = !arm.is_limited;
    const double speed_m_s = motion.max_speed_m_s, acceleration_m_s2 = motion.max_acceleration_m_s2;
    return {{AxisGroup::translation, bounds.x_low_m, bounds.x_high_m, 1, false, 1, speed_m_s, acceleration_m_s2},
            {AxisGroup::translation, bounds.z_low_m, bounds.z_high_m, 1, false, 1, speed_m_s, acceleration_m_s2},
            {AxisGroup::joint, wraps ? -std::numbers::pi : arm.lower_limit_rad,
             wraps ? std::numbers::pi : arm.upper_limit_rad, 0.5 * arm.length_m, wraps, arm.length_m,
             motion.max_arm_rate_rad_s, motion.max_arm_acceleration_rad_s2}};
}

}  // namespace

template <class Family>
SearchAxesOf<Family>::SearchAxesOf(std::vector<SearchAxis> axes) : axes_(std::move(axes)) {
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        if (axes_[axis].group == AxisGroup::translation) {
            translations_.push_back(axis);
        }
    }
}

template <class Family>
double SearchAxesOf<Family>::way(std::size_t axis, double from, double to) const noexcept {
    return axes_[axis].wraps ? lane::wrap_angle(to - from) : to - from;
}

SearchSpace::SearchSpace(const Problem& problem, const FlightModel& model)
    : SearchAxesOf<Plane>(search_axes(problem.bounds, problem.robot.arm, problem.motion)),
      model_(model),
      goal_(problem.goal),
      arm_weight_m_(0.5 * problem.robot.arm.length_m),
      margin_m_(problem.planner.safety_margin_m) {}

double SearchSpace::turn_rad(const Configuration& from, const Configuration& to) const noexcept {
    double largest = 0;
    for (std::size_t axis = 0; axis < axes().size(); ++axis) {
        if (axes()[axis].group == AxisGroup::joint) {
            largest = std::max(largest, std::abs(way(axis, from[axis], to[axis])));
        }
    }
    return largest;
}

template <class Family>
auto SearchAxesOf<Family>::seen_from(const Configuration& from, Configuration to) const noexcept -> Configuration {
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        if (axes_[axis].group != AxisGroup::translation) {
            to[axis] = from[axis] + way(axis, from[axis], to[axis]);
        }
    }
    return to;
}

template <class Family>
double SearchAxesOf<Family>::travel_m(const Configuration& a, const Configuration& b) const noexcept {
    double squares = 0;
    for (const std::size_t axis : translations_) {
        const double way = b[axis] - a[axis];
        squares += way * way;
    }
    return std::sqrt(squares);
}

double SearchSpace::distance_m(const Configuration& a, const Configuration& b) const noexcept {
    return std::sqrt(squared_distance_m2(a, b, HUGE_VAL));
}

double SearchSpace::squared_distance_m2(const Configuration& a, const Configuration& b,
                                        double enough_m2) const noexcept {
    double squares = 0;
    for (std::size_t axis = 0; axis < axes().size() && squares < enough_m2; ++axis) {
        const double length_m = axes()[axis].weight_m * way(axis, a[axis], b[axis]);
        squares += length_m * length_m;
    }
    return squares;
}

Configuration SearchSpace::steered(const Configuration& from, const Configuration& to, double range_m) const {
    const Configuration target = seen_from(from, to);
    const double distance = distance_m(from, target);
    if (distance <= range_m) {
        return target;
    }
    return between(from, target, range_m / distance);
}

template <class Family>
auto SearchAxesOf<Family>::sample(Random& random) const -> Configuration {
    Configuration c;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        c[axis] = random.uniform(axes_[axis].low, axes_[axis].high);
    }
    return c;
}

double SearchSpace::into_arm_range(double arm_rad, double near_rad) const noexcept {
    constexpr double turn = 2 * std::numbers::pi;
    const SearchAxis& arm = axes()[plane::arm];
    const double least = arm_rad - turn * std::floor((arm_rad - arm.low) / turn);
    const double turns_to_spare = std::floor((arm.high - least) / turn);
    if (arm.wraps || turns_to_spare < 1) {
        return least;
    }
    return least + turn * std::clamp(std::round((near_rad - least) / turn), 0.0, turns_to_spare);
}

template <class Family>
auto SearchAxesOf<Family>::sample_near(const Configuration& configuration, double radius_m, Random& random) const
    -> Configuration {
    Configuration c;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const SearchAxis& axis = axes_[i];
        const double radius = radius_m / axis.weight_m;
        c[i] = configuration[i] + random.uniform(-radius, radius);
        if (!axis.wraps) {
            c[i] = std::clamp(c[i], axis.low, axis.high);
        }
    }
    return c;
}

std::optional<Configuration> SearchSpace::sample_goal_near(const Configuration& configuration, double radius_m,
                                                           Random& random) const {
    const Goal& goal = nearest_goal(goal_, model_.tick().plant, level_at(configuration));
    const Configuration near = sample_near(configuration, radius_m, random);
    // Another place anywhere within a disc is near enough; a rectangle may be wide.
    const Configuration candidate = tolerance_of(goal).is_disc
                                        ? moved_to(goal, near, random)
                                        : moved_into(goal, near, usable_tolerance_share * random.uniform(0.5, 1));
    return is_valid(candidate) ? std::optional(candidate) : std::nullopt;
}

Configuration SearchSpace::moved_to(const Goal& goal, Configuration c, Random& random) const {
    // Half of the samples aim at the goal itself, the others anywhere in the usable part of its tolerance: where an
    // obstacle, a bound or a limit stands at the goal, only those can do.
    const GoalTolerance tolerance = tolerance_of(goal);
    const bool is_beside = random.chance(0.5);
    const double dx = random.uniform(-1, 1);
    const double dz = random.uniform(-1, 1);
    const double turn = tolerance.usable().angle_rad * random.uniform(-1, 1);
    if (const std::optional<double> angle_rad = level_arm_rad(goal)) {
        c[plane::arm] = into_arm_range(*angle_rad + (part_of(goal) == GoalPart::end_effector || is_beside ? turn : 0),
                                       c[plane::arm]);
    }
    const double radius = tolerance.is_disc ? std::max(1.0, std::sqrt(dx * dx + dz * dz)) : 1;
    const GoalTolerance beside = tolerance.times(is_beside ? usable_tolerance_share / radius : 0);
    return placed_at(goal, model_.tick().plant, c, beside.x_m * dx, beside.z_m * dz);
}

Configuration SearchSpace::moved_into_goal(Configuration c, double share) const {
    return moved_into(nearest_goal(goal_, model_.tick().plant, level_at(c)), c, share);
}

Configuration SearchSpace::moved_into(const Goal& goal, Configuration c, double share) const {
    const GoalTolerance limit = tolerance_of(goal).times(share);
    if (const std::optional<double> angle_rad = level_arm_rad(goal)) {
        const double turn = std::clamp(lane::wrap_angle(c[plane::arm] - *angle_rad), -limit.angle_rad, limit.angle_rad);
        c[plane::arm] = into_arm_range(*angle_rad + turn, c[plane::arm]);
    }
    const GoalDeviation d = goal_deviation(goal, model_.tick().plant, level_at(c));
    if (!limit.is_disc) {
        return placed_at(goal, model_.tick().plant, c, std::clamp(d.x_m, -limit.x_m, limit.x_m),
                         std::clamp(d.z_m, -limit.z_m, limit.z_m));
    }
    const double distance = std::sqrt(d.x_m * d.x_m + d.z_m * d.z_m);
    const double part = distance > limit.x_m ? limit.x_m / distance : 1;
    return placed_at(goal, model_.tick().plant, c, part * d.x_m, part * d.z_m);
}

std::optional<Configuration> SearchSpace::sample_goal(Random& random) const {
    constexpr int tries = 20;
    const std::span<const Goal> goals = alternatives(goal_);
    for (int i = 0; i < tries; ++i) {
        const auto drawn = goals.size() == 1 ? 0 : random.uniform(0, static_cast<double>(goals.size()));
        const Configuration candidate = moved_to(goals[static_cast<std::size_t>(drawn)], sample(random), random);
        if (is_valid(candidate)) {
            return candidate;
        }
    }
    return std::nullopt;
}

GoalError SearchSpace::error(const Configuration& c) const {
    return goal_error(goal_, model_.tick().plant, level_at(c));
}

double SearchSpace::hold_s(const Configuration& c) const {
    return nearest_goal(goal_, model_.tick().plant, level_at(c)).hold_s;
}

bool SearchSpace::is_near_goal(const Configuration& c) const {
    // A hair more than the share: samples right at its rim shall count.
    return error(c).used_share <= usable_tolerance_share + 1e-6;
}

double SearchSpace::goal_distance_m(const Configuration& c) const {
    if (is_near_goal(c)) {
        return 0;
    }
    double least = HUGE_VAL;
    for (const Goal& goal : alternatives(goal_)) {
        const GoalError off = error_beyond_tolerance(goal, c);
        least = std::min(least, off.distance_m + arm_weight_m() * off.angle_rad);
    }
    return least;
}

GoalError SearchSpace::error_beyond_tolerance(const Goal& goal, const Configuration& c) const {
    const GoalDeviation d = goal_deviation(goal, model_.tick().plant, level_at(c));
    const GoalTolerance tolerance = tolerance_of(goal);
    const GoalTolerance usable = tolerance.usable();
    const auto beyond = [](double deviation, double limit) { return std::max(0.0, std::abs(deviation) - limit); };
    const auto length = [](double x, double z) { return std::sqrt(x * x + z * z); };
    return {usable.is_disc ? beyond(length(d.x_m, d.z_m), usable.x_m)
                           : length(beyond(d.x_m, usable.x_m), beyond(d.z_m, usable.z_m)),
            beyond(d.angle_rad, usable.angle_rad), tolerance.used_share(d)};
}

template <class Family>
Rejection SearchAxesOf<Family>::limit_left_at(const Configuration& c) const noexcept {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const SearchAxis& axis = axes_[i];
        if (!axis.wraps && !(c[i] >= axis.low && c[i] <= axis.high)) {
            return axis.group == AxisGroup::translation ? Rejection::bounds : Rejection::arm_limits;
        }
    }
    return Rejection::none;
}

Rejection SearchSpace::rejection_at(const Configuration& c, double pitch_rad) const {
    PlanarPose pose = level_at(c);
    pose.pitch_rad = pitch_rad;
    return rejection_at(c, pose);
}

Rejection SearchSpace::rejection_at(const Configuration& c, const PlanarPose& pose) const {
    if (const Rejection left = limit_left_at(c); left != Rejection::none) {
        return left;
    }
    return model_.collisions().is_nearer_than(pose, margin_m_) ? Rejection::collision : Rejection::none;
}

PlanarPose SearchSpace::pose_along(const ReferencePoint& point, bool tilts) const {
    PlanarPose pose = level_at(configuration_of(point));
    pose.pitch_rad = tilts ? pitch_along(point) : 0;
    return pose;
}

std::int64_t SearchSpace::hold_ticks(const ReferencePoint& at) const {
    return downwash::hold_ticks(goal_, model_, at);
}

bool SearchSpace::is_met(const FlightState& vehicle) const {
    return meets_goal(goal_, model_.tick().plant, vehicle);
}

bool SearchSpace::is_allowed(const Configuration& configuration, QueryCounts& counts) const {
    const Rejection rejection = rejection_at(configuration);
    if (rejection == Rejection::collision) {
        count_collision(model_, level_at(configuration), margin_m_, counts.stopped_by);
    }
    return counts.note(rejection);
}

double SearchSpace::extent_m() const noexcept {
    double squares = 0;
    for (const SearchAxis& axis : axes()) {
        const double length_m = axis.weight_m * (axis.wraps ? std::numbers::pi : axis.high - axis.low);
        squares += length_m * length_m;
    }
    return std::sqrt(squares);
}

template class SearchAxesOf<Plane>;
template class SearchAxesOf<Space>;

}  // namespace downwash::planning
