#include "downwash/simulation/space_goal_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/space_aim.hpp"
#include "downwash/simulation/space_arm_angles.hpp"
#include "downwash/simulation/space_facets.hpp"
#include "downwash/simulation/space_goal_error.hpp"
#include "downwash/simulation/space_tool.hpp"
#include "downwash/simulation/space_touch_place.hpp"

namespace downwash {
namespace {

constexpr double pi = std::numbers::pi;
constexpr Vector3 up{0, 0, 1};

using simulation::Aim;
using simulation::Facet;
using simulation::Heading;
using simulation::yawed;
using simulation::YawRange;

using Quaternion = std::array<double, 4>;

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

}  // namespace

struct SpaceGoalSampler::Impl {
    /// A goal without alternatives, made ready.
    struct One {
        SpaceGoal goal;
        Quaternion attitude{};      ///< of a pose
        Vector3 up_in_hand{};       ///< of a pose
        std::vector<Facet> facets;  ///< that a contact may touch
        std::shared_ptr<const Scene> touched;
    };

    SpaceRobot robot;
    SpaceBounds bounds;
    std::shared_ptr<const Scene> scene;
    SpaceChecker checker;
    double margin_m;
    SpaceArmAngles arm;
    std::vector<One> ones;

    using Found = std::optional<SpaceConfiguration>;

    /// The robot with its end effector at a place.
    [[nodiscard]] SpaceConfiguration placed(const Heading& heading, const Vector3& end_effector_m) const {
        const Vector3 at_m = end_effector_m - yawed(heading.yaw_rad, arm.end_effector_m(heading.joints));
        SpaceConfiguration at{};
        std::copy(at_m.begin(), at_m.end(), at.begin());
        at[space::yaw] = heading.yaw_rad;
        std::copy_n(heading.joints.begin(), arm.joints(), at.begin() + space::first_joint);
        return at;
    }
    [[nodiscard]] static Heading heading_of(const SpaceConfiguration& at) {
        Heading heading;
        std::copy_n(at.begin() + space::first_joint, max_joints, heading.joints.begin());
        heading.yaw_rad = at[space::yaw];
        return heading;
    }
    [[nodiscard]] Vector3 end_of(const SpaceConfiguration& at) const {
        const Heading heading = heading_of(at);
        return Vector3{at[0], at[1], at[2]} + yawed(heading.yaw_rad, arm.end_effector_m(heading.joints));
    }

    // Drawing.

    [[nodiscard]] Heading any_heading(Random& random) const {
        const JointAngles joints = arm.drawn(random);
        return {joints, random.uniform(-pi, pi)};
    }

    [[nodiscard]] std::optional<Heading> drawn_at(const Aim& aim, Random& random) const {
        return simulation::drawn_heading(aim, arm, random);
    }

    [[nodiscard]] Found drawn(const SpaceEndEffectorGoal& goal, const One&, double share, Random& random) const {
        std::optional<Heading> heading;
        if (goal.direction) {
            heading = drawn_at({arm.tool(), unit(*goal.direction), share * goal.direction_tolerance_rad}, random);
        } else {
            heading = any_heading(random);
        }
        const Vector3 beside_m = in_ball(random, share * goal.tolerance_m);
        return heading ? Found(placed(*heading, goal.position_m + beside_m)) : std::nullopt;
    }

    [[nodiscard]] Found drawn(const SpacePoseGoal& goal, const One& one, double share, Random& random) const {
        const std::optional<Heading> heading =
            drawn_at({one.up_in_hand, up, share * goal.tolerance_rad, &one.attitude}, random);
        const Vector3 beside_m = in_ball(random, share * goal.tolerance_m);
        return heading ? Found(placed(*heading, goal.position_m + beside_m)) : std::nullopt;
    }

    /// The line of sight of a camera that points somewhere, as near to that as the goal's direction allows.
    [[nodiscard]] static Vector3 line_of(const SpaceCameraGoal& goal, const Vector3& points, double share) {
        return goal.direction ? toward(unit(*goal.direction), points, share * goal.view_cone_rad) : points;
    }
    [[nodiscard]] static Aim view_of(const SpaceCameraGoal& goal, const Vector3& tool, double share) {
        return {tool, unit(*goal.direction), std::min(pi, share * (goal.view_cone_rad + goal.aim_tolerance_rad))};
    }

    [[nodiscard]] Found drawn(const SpaceCameraGoal& goal, const One&, double share, Random& random) const {
        const std::optional<Heading> heading =
            goal.direction ? drawn_at(view_of(goal, arm.tool(), share), random) : any_heading(random);
        const double off = share * random.uniform(-1, 1);
        if (!heading) {
            return std::nullopt;
        }
        const Vector3 line = line_of(goal, yawed(heading->yaw_rad, arm.outward(heading->joints, arm.tool())), share);
        const double away_m = 0.5 * ((1 - off) * goal.nearest_m + (1 + off) * goal.farthest_m);
        return placed(*heading, goal.target_m - away_m * line);
    }

    /// An angle of a joint within its limits that is the same as another one, or next to it.
    [[nodiscard]] double in_range(std::size_t joint, double angle_rad, double about_rad) const {
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

    [[nodiscard]] static std::array<bool, 3> given(const SpaceConfigurationGoal& goal) {
        return {goal.x_m.has_value(), goal.y_m.has_value(), goal.z_m.has_value()};
    }
    [[nodiscard]] static Vector3 place_of(const SpaceConfigurationGoal& goal) {
        return {goal.x_m.value_or(0), goal.y_m.value_or(0), goal.z_m.value_or(0)};
    }

    [[nodiscard]] Found drawn(const SpaceConfigurationGoal& goal, const One&, double share, Random& random) const {
        const Heading any = any_heading(random);
        SpaceConfiguration at{};
        const std::array<bool, 3> is_given = given(goal);
        const Vector3 beside_m = place_of(goal) + in_ball(random, share * goal.tolerance_m, is_given);
        for (std::size_t i = 0; i < 3; ++i) {
            const double any_m = random.uniform(bounds.low_m[i], bounds.high_m[i]);
            at[i] = is_given[i] ? beside_m[i] : any_m;
        }
        const auto beside = [&](double angle_rad) {
            return angle_rad + share * goal.tolerance_rad * random.uniform(-1, 1);
        };
        at[space::yaw] = goal.yaw_rad ? lane::wrap_angle(beside(*goal.yaw_rad)) : any.yaw_rad;
        for (std::size_t i = 0; i < arm.joints(); ++i) {
            at[space::first_joint + i] =
                goal.joints_rad.empty() ? any.joints[i] : in_range(i, beside(goal.joints_rad[i]), any.joints[i]);
        }
        return meets(goal, at, share);
    }

    /// The configuration, if the joints that its limits allow are near enough.
    [[nodiscard]] Found meets(const SpaceConfigurationGoal& goal, const SpaceConfiguration& at, double share) const {
        constexpr double rounding_rad = 1e-12;
        for (std::size_t i = 0; i < goal.joints_rad.size(); ++i) {
            if (std::abs(lane::wrap_angle(at[space::first_joint + i] - goal.joints_rad[i])) >
                share * goal.tolerance_rad + rounding_rad) {
                return std::nullopt;
            }
        }
        return at;
    }

    // Contacts.

    /// The robot in front of a point of a surface, moved to where it has to wait. Nothing if there is no touch from
    /// there.
    [[nodiscard]] Found before_touch(const SpaceContactGoal& goal, const One& one, const Heading& heading,
                                     const Vector3& surface_m, const Vector3& n, double share) const {
        SpaceConfiguration at = placed(heading, surface_m + goal.standoff_m * n);
        if (goal.part == TouchingPart::frame) {
            // Level below it: the touch says by how much the top is off.
            const Vector3 below_m = surface_m + (goal.standoff_m + robot_height_m()) * n;
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
        return found.touch && goal_error(*found.touch, robot, level_at(at)).used_share <= share + rounding
                   ? Found(at)
                   : std::nullopt;
    }
    /// Of the multirotor above its centre of mass, at most: it is not inside the surface from there.
    [[nodiscard]] double robot_height_m() const { return checker.robot_reach_m(); }

    /// @param n which way out of the surface
    [[nodiscard]] std::optional<Heading> heading_to_touch(const SpaceContactGoal& goal, const Vector3& n, double share,
                                                          Random& random) const {
        return goal.part == TouchingPart::frame ? any_heading(random)
                                                : drawn_at({arm.tool(), -1 * n, share * touch_angle_rad}, random);
    }

    [[nodiscard]] Found drawn(const SpaceContactGoal& goal, const One& one, double share, Random& random) const {
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
        const std::optional<Heading> heading = heading_to_touch(goal, n, share, random);
        return heading ? before_touch(goal, one, *heading, surface_m, n, share) : std::nullopt;
    }

    // The nearest.

    template <class Visit>
    void for_each_heading(const Aim& aim, const Heading& start, const Visit& visit) const {
        for (const Heading& heading : simulation::headings_near(aim, arm, start)) {
            visit(heading);
        }
    }

    /// Brings yaw and joints without limits to within half a turn of those of another configuration.
    void turn_next_to(const SpaceConfiguration& other, SpaceConfiguration& at) const {
        for (std::size_t axis = space::yaw; axis < space::first_joint + arm.joints(); ++axis) {
            const double way_rad = at[axis] - other[axis];
            if ((axis == space::yaw || !arm.is_limited(axis - space::first_joint)) && std::abs(way_rad) > pi) {
                at[axis] = other[axis] + lane::wrap_angle(way_rad);
            }
        }
    }

    /// Whether the first look finds the nearest place, or all that are looked for.
    [[nodiscard]] bool is_complete(std::size_t number) const {
        const SpaceGoalKind& kind = ones[number].goal.kind;
        return std::holds_alternative<SpaceConfigurationGoal>(kind) || std::holds_alternative<SpaceContactGoal>(kind);
    }

    [[nodiscard]] JointAngles within_limits(JointAngles joints) const {
        for (std::size_t i = 0; i < arm.joints(); ++i) {
            if (arm.is_limited(i)) {
                joints[i] = std::clamp(joints[i], arm.range(i).low_rad, arm.range(i).high_rad);
            }
        }
        return joints;
    }

    /// The robot with this heading and its end effector in a ball, as near as possible to where it is.
    [[nodiscard]] SpaceConfiguration placed_near(const SpaceConfiguration& from, const Heading& heading,
                                                 const Vector3& middle_m, double radius_m) const {
        const Vector3 end_m =
            Vector3{from[0], from[1], from[2]} + yawed(heading.yaw_rad, arm.end_effector_m(heading.joints));
        const Vector3 off_m = end_m - middle_m;
        const double away_m = length_of(off_m);
        return placed(heading, middle_m + (away_m > radius_m ? radius_m / away_m : 1) * off_m);
    }

    template <class Visit>
    void each_near(const SpaceEndEffectorGoal& goal, const One&, const SpaceConfiguration& from, const Heading& start,
                   double share, const Visit& visit) const {
        const auto place = [&](const Heading& heading) {
            visit(placed_near(from, heading, goal.position_m, share * goal.tolerance_m));
        };
        if (goal.direction) {
            for_each_heading({arm.tool(), unit(*goal.direction), share * goal.direction_tolerance_rad}, start, place);
        } else {
            place(start);
        }
    }

    template <class Visit>
    void each_near(const SpacePoseGoal& goal, const One& one, const SpaceConfiguration& from, const Heading& start,
                   double share, const Visit& visit) const {
        for_each_heading({one.up_in_hand, up, share * goal.tolerance_rad, &one.attitude}, start,
                         [&](const Heading& heading) {
                             visit(placed_near(from, heading, goal.position_m, share * goal.tolerance_m));
                         });
    }

    template <class Visit>
    void each_near(const SpaceCameraGoal& goal, const One&, const SpaceConfiguration& from, const Heading& start,
                   double share, const Visit& visit) const {
        const double middle_m = 0.5 * (goal.nearest_m + goal.farthest_m);
        const double half_m = 0.5 * share * (goal.farthest_m - goal.nearest_m);
        const auto place = [&](const Heading& heading, const Vector3& line) {
            const Vector3 end_m =
                Vector3{from[0], from[1], from[2]} + yawed(heading.yaw_rad, arm.end_effector_m(heading.joints));
            const double away_m = std::clamp(dot(goal.target_m - end_m, line), middle_m - half_m, middle_m + half_m);
            visit(placed(heading, goal.target_m - away_m * line));
        };
        const auto as_it_points = [&](const Heading& heading) {
            place(heading, line_of(goal, yawed(heading.yaw_rad, arm.outward(heading.joints, arm.tool())), share));
        };
        if (goal.direction) {
            for_each_heading(view_of(goal, arm.tool(), share), start, as_it_points);
        } else {
            as_it_points(start);
        }
        // Looking at the target from where it is, with its arm and yaw as they are.
        const Vector3 now = goal.target_m - (Vector3{from[0], from[1], from[2]} +
                                             yawed(start.yaw_rad, arm.end_effector_m(start.joints)));
        if (length_of(now) > 0) {
            const Vector3 line = line_of(goal, unit(now), share);
            for_each_heading({arm.tool(), line, share * goal.aim_tolerance_rad}, start,
                             [&](const Heading& heading) { place(heading, line); });
        }
    }

    template <class Visit>
    void each_near(const SpaceConfigurationGoal& goal, const One&, const SpaceConfiguration& from, const Heading&,
                   double share, const Visit& visit) const {
        SpaceConfiguration at = from;
        const std::array<bool, 3> is_given = given(goal);
        Vector3 off_m{};
        for (std::size_t i = 0; i < 3; ++i) {
            off_m[i] = is_given[i] ? from[i] - place_of(goal)[i] : 0;
        }
        const double away_m = length_of(off_m), radius_m = share * goal.tolerance_m;
        for (std::size_t i = 0; i < 3; ++i) {
            at[i] = is_given[i] ? place_of(goal)[i] + (away_m > radius_m ? radius_m / away_m : 1) * off_m[i]
                                : std::clamp(from[i], bounds.low_m[i], bounds.high_m[i]);
        }
        const double room_rad = share * goal.tolerance_rad;
        if (goal.yaw_rad) {
            at[space::yaw] = YawRange{*goal.yaw_rad, room_rad}.nearest_to(from[space::yaw]);
        }
        const JointAngles joints = within_limits(heading_of(from).joints);
        for (std::size_t i = 0; i < arm.joints(); ++i) {
            const double now_rad = joints[i];
            at[space::first_joint + i] =
                goal.joints_rad.empty()
                    ? now_rad
                    : in_range(i, YawRange{in_range(i, goal.joints_rad[i], now_rad), room_rad}.nearest_to(now_rad),
                               now_rad);
        }
        if (const Found found = meets(goal, at, share)) {
            visit(*found);
        }
    }

    /// The facets of a surface that are nearest to a point, at most so many.
    [[nodiscard]] static std::vector<const Facet*> facets_near(const One& one, const Vector3& to_m, std::size_t most) {
        std::vector<std::pair<double, const Facet*>> all;
        for (const Facet& facet : one.facets) {
            all.emplace_back(length_of(facet.nearest_m(to_m) - to_m), &facet);
        }
        const auto end = all.begin() + static_cast<std::ptrdiff_t>(std::min(most, all.size()));
        std::partial_sort(all.begin(), end, all.end());
        std::vector<const Facet*> near;
        std::transform(all.begin(), end, std::back_inserter(near), [](const auto& each) { return each.second; });
        return near;
    }

    template <class Visit>
    void each_near(const SpaceContactGoal& goal, const One& one, const SpaceConfiguration& from, const Heading& start,
                   double share, const Visit& visit) const {
        constexpr std::size_t most_facets = 8;
        const Vector3 end_m = end_of(from);
        for (const Facet* each : facets_near(one, end_m, most_facets)) {
            const Facet& facet = *each;
            const double above_m = dot(end_m - facet.corner_m, facet.n);
            const Vector3 n = facet.has_two_sides && above_m < 0 ? -1 * facet.n : facet.n;
            const auto place = [&](const Heading& heading) {
                // The nearest point may be at an edge, where nothing can be touched; the middle is the farthest from
                // all edges.
                const Vector3 wanted_m = goal.position_m.value_or(end_m);
                const Vector3 on_plane_m = wanted_m - dot(wanted_m - facet.corner_m, n) * n;
                Found found =
                    before_touch(goal, one, heading, goal.position_m ? on_plane_m : facet.nearest_m(end_m), n, share);
                if (!found && !goal.position_m) {
                    found = before_touch(goal, one, heading, facet.middle_m(), n, share);
                }
                if (found) {
                    visit(*found);
                }
            };
            if (goal.part == TouchingPart::frame) {
                place(start);
            } else {
                for_each_heading({arm.tool(), -1 * n, share * touch_angle_rad}, start, place);
            }
        }
    }
};

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
    const std::optional<SpaceConfiguration> at =
        std::visit([&](const auto& kind) { return impl_->drawn(kind, one, share, random); }, one.goal.kind);
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

std::optional<SpaceGoalPlace> SpaceGoalSampler::nearest(const SpaceConfiguration& to, const SpaceMetric& metric,
                                                        double share, int refinements) const {
    const Impl& own = *impl_;
    std::optional<SpaceGoalPlace> best;
    double least = HUGE_VAL;
    const auto look_from = [&](const Heading& start, std::size_t number) {
        const Impl::One& one = own.ones[number];
        const auto consider = [&](SpaceConfiguration at) {
            own.turn_next_to(to, at);
            const double away = metric(to, at);
            if (away < least) {
                best = SpaceGoalPlace{at, number};
                least = away;
            }
        };
        std::visit([&](const auto& kind) { own.each_near(kind, one, to, start, share, consider); }, one.goal.kind);
    };
    Heading given = Impl::heading_of(to);
    given.joints = own.within_limits(given.joints);
    for (std::size_t number = 0; number < own.ones.size(); ++number) {
        look_from(given, number);
    }
    if (!best || own.is_complete(best->alternative)) {
        return best;
    }
    // From beside the best one so far, nearer and nearer to it.
    constexpr double first_step_rad = 2.5, factor = 0.9;
    Random random(1);
    double step_rad = first_step_rad;
    for (int i = 0; i < refinements; ++i, step_rad *= factor) {
        Heading beside = Impl::heading_of(best->at);
        const std::size_t turned = random.index(own.arm.joints() + 1);  // one of them, or all
        for (std::size_t joint = 0; joint < own.arm.joints(); ++joint) {
            const double way_rad = step_rad * random.uniform(-1, 1);
            beside.joints[joint] += turned == own.arm.joints() || turned == joint ? way_rad : 0;
        }
        beside.joints = own.within_limits(beside.joints);
        beside.yaw_rad += step_rad * random.uniform(-1, 1);
        look_from(beside, best->alternative);
    }
    return best;
}

}  // namespace downwash
