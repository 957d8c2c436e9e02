#include "downwash/simulation/space_goal_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <variant>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/space_goal_error.hpp"
#include "downwash/simulation/space_goal_places.hpp"
#include "downwash/simulation/space_tool.hpp"
#include "downwash/simulation/space_touch_place.hpp"

namespace downwash {
namespace {

constexpr double pi = std::numbers::pi;

using simulation::Aim;
using simulation::Facet;
using simulation::Heading;
using simulation::yawed;

using Impl = SpaceGoalSampler::Impl;

/// From one direction toward another one by an angle; at most as far as that.
Vector3 toward(const Vector3& from, const Vector3& to, double angle_rad) {
    if (angle_between_rad(from, to) <= angle_rad) {
        return to;
    }
    const Vector3 axis = cross(from, to);
    const Vector3 about = length_of(axis) > 0 ? unit(axis) : across(from);
    const auto [sine, cosine] = lane::sin_cos(angle_rad);
    return cosine * from + sine * cross(about, from);
}

/// Evenly spread in a ball, or in a disc or a stretch of the coordinates that count.
Vector3 in_ball(Random& random, double radius, const std::array<bool, 3>& counts = {true, true, true}) {
    for (;;) {
        Vector3 v{};
        for (std::size_t i = 0; i < 3; ++i) {
            v[i] = counts[i] ? random.uniform(-1, 1) : 0;
        }
        if (dot(v, v) <= 1) {
            return radius * v;
        }
    }
}

/// Draws a configuration for a goal of each kind.
struct Drawing {
    using Found = Impl::Found;

    const Impl& own;
    const Impl::One& one;
    double share;
    Random& random;

    [[nodiscard]] Heading any_heading() const {
        const JointAngles joints = own.arm.drawn(random);
        return {joints, random.uniform(-pi, pi)};
    }

    [[nodiscard]] std::optional<Heading> drawn_at(const Aim& aim) const {
        return simulation::drawn_heading(aim, own.arm, random);
    }

    [[nodiscard]] Found operator()(const SpaceEndEffectorGoal& goal) const {
        std::optional<Heading> heading;
        if (goal.direction) {
            heading = drawn_at({own.arm.tool(), unit(*goal.direction), share * goal.direction_tolerance_rad});
        } else {
            heading = any_heading();
        }
        const Vector3 beside_m = in_ball(random, share * goal.tolerance_m);
        return heading ? Found(own.placed(*heading, goal.position_m + beside_m)) : std::nullopt;
    }

    [[nodiscard]] Found operator()(const SpacePoseGoal& goal) const {
        const std::optional<Heading> heading =
            drawn_at({one.up_in_hand, Impl::up, share * goal.tolerance_rad, &one.attitude});
        const Vector3 beside_m = in_ball(random, share * goal.tolerance_m);
        return heading ? Found(own.placed(*heading, goal.position_m + beside_m)) : std::nullopt;
    }

    [[nodiscard]] Found operator()(const SpaceCameraGoal& goal) const {
        const std::optional<Heading> heading =
            goal.direction ? drawn_at(Impl::view_of(goal, own.arm.tool(), share)) : any_heading();
        const double off = share * random.uniform(-1, 1);
        if (!heading) {
            return std::nullopt;
        }
        const Vector3 line =
            Impl::line_of(goal, yawed(heading->yaw_rad, own.arm.outward(heading->joints, own.arm.tool())), share);
        const double away_m = 0.5 * ((1 - off) * goal.nearest_m + (1 + off) * goal.farthest_m);
        return own.placed(*heading, goal.target_m - away_m * line);
    }

    [[nodiscard]] Found operator()(const SpaceConfigurationGoal& goal) const {
        const Heading any = any_heading();
        SpaceConfiguration at{};
        const std::array<bool, 3> is_given = Impl::given(goal);
        const Vector3 beside_m = Impl::place_of(goal) + in_ball(random, share * goal.tolerance_m, is_given);
        for (std::size_t i = 0; i < 3; ++i) {
            const double any_m = random.uniform(own.bounds.low_m[i], own.bounds.high_m[i]);
            at[i] = is_given[i] ? beside_m[i] : any_m;
        }
        const auto beside = [&](double angle_rad) {
            return angle_rad + share * goal.tolerance_rad * random.uniform(-1, 1);
        };
        at[space::yaw] = goal.yaw_rad ? lane::wrap_angle(beside(*goal.yaw_rad)) : any.yaw_rad;
        for (std::size_t i = 0; i < own.arm.joints(); ++i) {
            at[space::first_joint + i] =
                goal.joints_rad.empty() ? any.joints[i] : own.in_range(i, beside(goal.joints_rad[i]), any.joints[i]);
        }
        return own.meets(goal, at, share);
    }

    /// @param n which way out of the surface
    [[nodiscard]] std::optional<Heading> heading_to_touch(const SpaceContactGoal& goal, const Vector3& n) const {
        return goal.part == TouchingPart::frame ? any_heading()
                                                : drawn_at({own.arm.tool(), -1 * n, share * touch_angle_rad});
    }

    [[nodiscard]] Found operator()(const SpaceContactGoal& goal) const {
        if (one.facets.empty()) {
            return std::nullopt;
        }
        const double until_m2 = random.uniform(0, one.facets.back().area_until_m2);
        const Facet& facet =
            *std::upper_bound(one.facets.begin(), one.facets.end() - 1, until_m2,
                              [](double area_m2, const Facet& each) { return area_m2 < each.area_until_m2; });
        double s = random.uniform(0, 1), t = random.uniform(0, 1);
        if (s + t > 1) {
            s = 1 - s;
            t = 1 - t;
        }
        const double side = facet.has_two_sides && random.chance(0.5) ? -1 : 1;
        const Vector3 n = side * facet.n;
        Vector3 surface_m = facet.corner_m + s * facet.first_m + t * facet.second_m;
        if (goal.position_m) {
            surface_m = *goal.position_m - dot(*goal.position_m - facet.corner_m, n) * n;
        }
        const std::optional<Heading> heading = heading_to_touch(goal, n);
        return heading ? own.before_touch(goal, one, *heading, surface_m, n, share) : std::nullopt;
    }
};

}  // namespace

SpaceConfiguration SpaceGoalSampler::Impl::placed(const Heading& heading, const Vector3& end_effector_m) const {
    const Vector3 at_m = end_effector_m - yawed(heading.yaw_rad, arm.end_effector_m(heading.joints));
    SpaceConfiguration at{};
    std::copy(at_m.begin(), at_m.end(), at.begin());
    at[space::yaw] = heading.yaw_rad;
    std::copy_n(heading.joints.begin(), arm.joints(), at.begin() + space::first_joint);
    return at;
}

SpaceGoalSampler::Impl::Heading SpaceGoalSampler::Impl::heading_of(const SpaceConfiguration& at) {
    Heading heading;
    std::copy_n(at.begin() + space::first_joint, max_joints, heading.joints.begin());
    heading.yaw_rad = at[space::yaw];
    return heading;
}

Vector3 SpaceGoalSampler::Impl::end_of(const SpaceConfiguration& at) const {
    const Heading heading = heading_of(at);
    return Vector3{at[0], at[1], at[2]} + yawed(heading.yaw_rad, arm.end_effector_m(heading.joints));
}

Vector3 SpaceGoalSampler::Impl::line_of(const SpaceCameraGoal& goal, const Vector3& points, double share) {
    return goal.direction ? toward(unit(*goal.direction), points, share * goal.view_cone_rad) : points;
}

SpaceGoalSampler::Impl::Aim SpaceGoalSampler::Impl::view_of(const SpaceCameraGoal& goal, const Vector3& tool,
                                                            double share) {
    return {tool, unit(*goal.direction), std::min(pi, share * (goal.view_cone_rad + goal.aim_tolerance_rad))};
}

double SpaceGoalSampler::Impl::in_range(std::size_t joint, double angle_rad, double about_rad) const {
    const AngleRange range = arm.range_about(joint, about_rad);
    const double turns = std::round((about_rad - angle_rad) / (2 * pi));
    double best_rad = HUGE_VAL;
    for (const double more : {0.0, 1.0, -1.0}) {
        const double same_rad = angle_rad + (turns + more) * 2 * pi;
        if (same_rad >= range.low_rad && same_rad <= range.high_rad &&
            !(std::abs(best_rad - about_rad) <= std::abs(same_rad - about_rad))) {
            best_rad = same_rad;
        }
    }
    if (best_rad != HUGE_VAL) {
        return best_rad;
    }
    const double to_low = std::abs(lane::wrap_angle(angle_rad - range.low_rad));
    return to_low < std::abs(lane::wrap_angle(angle_rad - range.high_rad)) ? range.low_rad : range.high_rad;
}

std::array<bool, 3> SpaceGoalSampler::Impl::given(const SpaceConfigurationGoal& goal) {
    return {goal.x_m.has_value(), goal.y_m.has_value(), goal.z_m.has_value()};
}

Vector3 SpaceGoalSampler::Impl::place_of(const SpaceConfigurationGoal& goal) {
    return {goal.x_m.value_or(0), goal.y_m.value_or(0), goal.z_m.value_or(0)};
}

SpaceGoalSampler::Impl::Found SpaceGoalSampler::Impl::meets(const SpaceConfigurationGoal& goal,
                                                            const SpaceConfiguration& at, double share) const {
    constexpr double rounding_rad = 1e-12;
    for (std::size_t i = 0; i < goal.joints_rad.size(); ++i) {
        if (std::abs(lane::wrap_angle(at[space::first_joint + i] - goal.joints_rad[i])) >
            share * goal.tolerance_rad + rounding_rad) {
            return std::nullopt;
        }
    }
    return at;
}

SpaceGoalSampler::Impl::Found SpaceGoalSampler::Impl::before_touch(const SpaceContactGoal& goal, const One& one,
                                                                   const Heading& heading, const Vector3& surface_m,
                                                                   const Vector3& n, double share) const {
    SpaceConfiguration at = placed(heading, surface_m + goal.standoff_m * n);
    if (goal.part == TouchingPart::frame) {
        // Level below it: the touch says by how much the top is off.
        const Vector3 below_m = surface_m + (goal.standoff_m + checker.robot_reach_m()) * n;
        std::copy(below_m.begin(), below_m.end(), at.begin());
    }
    for (int i = 0; i < 2; ++i) {
        const FoundTouch found = find_touch(goal, 1, robot, level_at(at), *one.touched);
        if (!found.touch) {
            return std::nullopt;
        }
        const Vector3 off_m = found.touch->waiting_m - middle_of(*found.touch, robot, level_at(at));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[axis] += off_m[axis];
        }
    }
    const FoundTouch found = find_touch(goal, 1, robot, level_at(at), *one.touched);
    constexpr double rounding = 1e-9;
    return found.touch && goal_error(*found.touch, robot, level_at(at)).used_share <= share + rounding ? Found(at)
                                                                                                       : std::nullopt;
}

SpaceGoalSampler::SpaceGoalSampler(const SpaceRobot& robot, const SpaceBounds& bounds,
                                   std::shared_ptr<const Scene> scene, SpaceChecker checker, double margin_m,
                                   const SpaceGoal& goal) {
    auto impl = std::make_unique<Impl>(
        Impl{robot, bounds, std::move(scene), std::move(checker), margin_m, SpaceArmAngles(robot), {}});
    const std::span<const SpaceGoal> all =
        goal.any_of.empty() ? std::span<const SpaceGoal>(&goal, 1) : std::span<const SpaceGoal>(goal.any_of);
    for (const SpaceGoal& each : all) {
        Impl::One& one = impl->ones.emplace_back();
        one.goal = each;
        if (const auto* pose = std::get_if<SpacePoseGoal>(&each.kind)) {
            one.attitude = attitude_of(pose->rpy_rad);
            one.up_in_hand = rotation_of(one.attitude)[2];
        }
        if (const auto* contact = std::get_if<SpaceContactGoal>(&each.kind)) {
            std::vector<Obstacle> named;
            for (const Obstacle& obstacle : impl->scene->obstacles()) {
                if (obstacle.name == contact->obstacle) {
                    named.push_back(obstacle);
                }
            }
            one.facets = simulation::facets_of(*contact, named);
            one.touched = std::make_shared<const Scene>(std::move(named));
        }
    }
    impl_ = std::move(impl);
}

SpaceGoalSampler::~SpaceGoalSampler() = default;

std::optional<SpaceGoalPlace> SpaceGoalSampler::drawn(Random& random, double share) const {
    const std::size_t number = impl_->ones.size() == 1 ? 0 : random.index(impl_->ones.size());
    const Impl::One& one = impl_->ones[number];
    const std::optional<SpaceConfiguration> at = std::visit(Drawing{*impl_, one, share, random}, one.goal.kind);
    return at ? std::optional(SpaceGoalPlace{*at, number}) : std::nullopt;
}

SpaceGoalFlaw SpaceGoalSampler::flaw(const SpaceGoalPlace& place) const {
    const Impl& own = *impl_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(place.at[axis] >= own.bounds.low_m[axis] && place.at[axis] <= own.bounds.high_m[axis])) {
            return SpaceGoalFlaw::outside;
        }
    }
    const SpacePose pose = level_at(place.at);
    if (own.checker.is_nearer_than(pose, own.margin_m)) {
        return own.checker.touching_bodies(pose) ? SpaceGoalFlaw::touches_itself : SpaceGoalFlaw::near_obstacle;
    }
    const auto* camera = std::get_if<SpaceCameraGoal>(&own.ones[place.alternative].goal.kind);
    if (camera != nullptr && camera->sees && !sees(*own.scene, own.end_of(place.at), camera->target_m)) {
        return SpaceGoalFlaw::hidden;
    }
    return SpaceGoalFlaw::none;
}

SpaceGoalSample SpaceGoalSampler::sample(Random& random, double share, int max_tries) const {
    SpaceGoalSample sample;
    while (!sample.place && sample.tries < max_tries) {
        ++sample.tries;
        const std::optional<SpaceGoalPlace> place = drawn(random, share);
        if (!place) {
            ++sample.without_aim;
            continue;
        }
        const SpaceGoalFlaw found = flaw(*place);
        ++sample.flaws[static_cast<std::size_t>(found)];
        if (found == SpaceGoalFlaw::none) {
            sample.place = place;
        }
    }
    return sample;
}

}  // namespace downwash
