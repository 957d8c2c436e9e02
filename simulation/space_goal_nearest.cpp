#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>
#include <variant>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/space_goal_places.hpp"
#include "downwash/simulation/space_goal_sampler.hpp"
#include "downwash/simulation/space_touch_place.hpp"

namespace downwash {
namespace {

constexpr double pi = std::numbers::pi;

using simulation::Aim;
using simulation::Facet;
using simulation::Heading;
using simulation::yawed;
using simulation::YawRange;

using Impl = SpaceGoalSampler::Impl;

/// Brings yaw and joints without limits to within half a turn of those of another configuration.
void turn_next_to(const Impl& own, const SpaceConfiguration& other, SpaceConfiguration& at) {
    for (std::size_t axis = space::yaw; axis < space::first_joint + own.arm.joints(); ++axis) {
        const double way_rad = at[axis] - other[axis];
        if ((axis == space::yaw || !own.arm.is_limited(axis - space::first_joint)) && std::abs(way_rad) > pi) {
            at[axis] = other[axis] + lane::wrap_angle(way_rad);
        }
    }
}

/// Whether the first look finds the nearest place, or all that are looked for.
bool is_complete(const Impl::One& one) {
    const SpaceGoalKind& kind = one.goal.kind;
    return std::holds_alternative<SpaceConfigurationGoal>(kind) || std::holds_alternative<SpaceContactGoal>(kind);
}

JointAngles within_limits(const Impl& own, JointAngles joints) {
    for (std::size_t i = 0; i < own.arm.joints(); ++i) {
        if (own.arm.is_limited(i)) {
            joints[i] = std::clamp(joints[i], own.arm.range(i).low_rad, own.arm.range(i).high_rad);
        }
    }
    return joints;
}

/// The facets of a surface that are nearest to a point, at most so many.
std::vector<const Facet*> facets_near(const Impl::One& one, const Vector3& to_m, std::size_t most) {
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

/// Places that meet a goal of each kind, near a configuration.
template <class Visit>
struct NearPlaces {
    using Found = Impl::Found;

    const Impl& own;
    const Impl::One& one;
    const SpaceConfiguration& from;
    const Heading& start;  ///< from which the arm and yaw are turned
    double share;
    const Visit& visit;

    template <class Each>
    void for_each_heading(const Aim& aim, const Each& each) const {
        for (const Heading& heading : simulation::headings_near(aim, own.arm, start)) {
            each(heading);
        }
    }

    /// The robot with this heading and its end effector in a ball, as near as possible to where it is.
    [[nodiscard]] SpaceConfiguration placed_near(const Heading& heading, const Vector3& middle_m,
                                                 double radius_m) const {
        const Vector3 end_m =
            Vector3{from[0], from[1], from[2]} + yawed(heading.yaw_rad, own.arm.end_effector_m(heading.joints));
        const Vector3 off_m = end_m - middle_m;
        const double away_m = length_of(off_m);
        return own.placed(heading, middle_m + (away_m > radius_m ? radius_m / away_m : 1) * off_m);
    }

    void operator()(const SpaceEndEffectorGoal& goal) const {
        const auto place = [&](const Heading& heading) {
            visit(placed_near(heading, goal.position_m, share * goal.tolerance_m));
        };
        if (goal.direction) {
            for_each_heading({own.arm.tool(), unit(*goal.direction), share * goal.direction_tolerance_rad}, place);
        } else {
            place(start);
        }
    }

    void operator()(const SpacePoseGoal& goal) const {
        for_each_heading(
            {one.up_in_hand, Impl::up, share * goal.tolerance_rad, &one.attitude},
            [&](const Heading& heading) { visit(placed_near(heading, goal.position_m, share * goal.tolerance_m)); });
    }

    void operator()(const SpaceCameraGoal& goal) const {
        const double middle_m = 0.5 * (goal.nearest_m + goal.farthest_m);
        const double half_m = 0.5 * share * (goal.farthest_m - goal.nearest_m);
        const auto place = [&](const Heading& heading, const Vector3& line) {
            const Vector3 end_m =
                Vector3{from[0], from[1], from[2]} + yawed(heading.yaw_rad, own.arm.end_effector_m(heading.joints));
            const double away_m = std::clamp(dot(goal.target_m - end_m, line), middle_m - half_m, middle_m + half_m);
            visit(own.placed(heading, goal.target_m - away_m * line));
        };
        const auto as_it_points = [&](const Heading& heading) {
            place(heading,
                  Impl::line_of(goal, yawed(heading.yaw_rad, own.arm.outward(heading.joints, own.arm.tool())), share));
        };
        if (goal.direction) {
            for_each_heading(Impl::view_of(goal, own.arm.tool(), share), as_it_points);
        } else {
            as_it_points(start);
        }
        // Looking at the target from where it is, with its arm and yaw as they are.
        const Vector3 now = goal.target_m - (Vector3{from[0], from[1], from[2]} +
                                             yawed(start.yaw_rad, own.arm.end_effector_m(start.joints)));
        if (length_of(now) > 0) {
            const Vector3 line = Impl::line_of(goal, unit(now), share);
            for_each_heading({own.arm.tool(), line, share * goal.aim_tolerance_rad},
                             [&](const Heading& heading) { place(heading, line); });
        }
    }

    void operator()(const SpaceConfigurationGoal& goal) const {
        SpaceConfiguration at = from;
        const std::array<bool, 3> is_given = Impl::given(goal);
        Vector3 off_m{};
        for (std::size_t i = 0; i < 3; ++i) {
            off_m[i] = is_given[i] ? from[i] - Impl::place_of(goal)[i] : 0;
        }
        const double away_m = length_of(off_m), radius_m = share * goal.tolerance_m;
        for (std::size_t i = 0; i < 3; ++i) {
            at[i] = is_given[i] ? Impl::place_of(goal)[i] + (away_m > radius_m ? radius_m / away_m : 1) * off_m[i]
                                : std::clamp(from[i], own.bounds.low_m[i], own.bounds.high_m[i]);
        }
        const double room_rad = share * goal.tolerance_rad;
        if (goal.yaw_rad) {
            at[space::yaw] = YawRange{*goal.yaw_rad, room_rad}.nearest_to(from[space::yaw]);
        }
        const JointAngles joints = within_limits(own, Impl::heading_of(from).joints);
        for (std::size_t i = 0; i < own.arm.joints(); ++i) {
            const double now_rad = joints[i];
            at[space::first_joint + i] =
                goal.joints_rad.empty()
                    ? now_rad
                    : own.in_range(i,
                                   YawRange{own.in_range(i, goal.joints_rad[i], now_rad), room_rad}.nearest_to(now_rad),
                                   now_rad);
        }
        if (const Found found = own.meets(goal, at, share)) {
            visit(*found);
        }
    }

    void operator()(const SpaceContactGoal& goal) const {
        constexpr std::size_t most_facets = 8;
        const Vector3 end_m = own.end_of(from);
        for (const Facet* each : facets_near(one, end_m, most_facets)) {
            const Facet& facet = *each;
            const double above_m = dot(end_m - facet.corner_m, facet.n);
            const Vector3 n = facet.has_two_sides && above_m < 0 ? -1 * facet.n : facet.n;
            const auto place = [&](const Heading& heading) {
                // The nearest point may be at an edge, where nothing can be touched; the middle is the farthest from
                // all edges.
                const Vector3 wanted_m = goal.position_m.value_or(end_m);
                const Vector3 on_plane_m = wanted_m - dot(wanted_m - facet.corner_m, n) * n;
                Found found = own.before_touch(goal, one, heading,
                                               goal.position_m ? on_plane_m : facet.nearest_m(end_m), n, share);
                if (!found && !goal.position_m) {
                    found = own.before_touch(goal, one, heading, facet.middle_m(), n, share);
                }
                if (found) {
                    visit(*found);
                }
            };
            if (goal.part == TouchingPart::frame) {
                place(start);
            } else {
                for_each_heading({own.arm.tool(), -1 * n, share * touch_angle_rad}, place);
            }
        }
    }
};

}  // namespace

std::optional<SpaceGoalPlace> SpaceGoalSampler::nearest(const SpaceConfiguration& to, const SpaceMetric& metric,
                                                        double share, int refinements) const {
    const Impl& own = *impl_;
    std::optional<SpaceGoalPlace> best;
    double least = HUGE_VAL;
    const auto look_from = [&](const Heading& start, std::size_t number) {
        const Impl::One& one = own.ones[number];
        const auto consider = [&](SpaceConfiguration at) {
            turn_next_to(own, to, at);
            const double away = metric(to, at);
            if (away < least) {
                best = SpaceGoalPlace{at, number};
                least = away;
            }
        };
        std::visit(NearPlaces<decltype(consider)>{own, one, to, start, share, consider}, one.goal.kind);
    };
    Heading given = Impl::heading_of(to);
    given.joints = within_limits(own, given.joints);
    for (std::size_t number = 0; number < own.ones.size(); ++number) {
        look_from(given, number);
    }
    if (!best || is_complete(own.ones[best->alternative])) {
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
        beside.joints = within_limits(own, beside.joints);
        beside.yaw_rad += step_rad * random.uniform(-1, 1);
        look_from(beside, best->alternative);
    }
    return best;
}

}  // namespace downwash
