#include "downwash/search/plan_changes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace downwash::planning {
namespace {

// How often what is changed; shares of one, the rest changes speeds alone.
constexpr double moves_goal = 0.10;
constexpr double adds_corner = 0.05;
constexpr double leaves_corner_out = 0.10;
constexpr double flies_through = 0.15;
constexpr double moves_corner = 0.15;
constexpr double moves_and_changes_speed = 0.35;

constexpr double largest_shift_m = 1.0;
constexpr double largest_speed_change = 0.5;     ///< as a share of the limits of motion
constexpr double shortest_split_s = 1.0;         ///< a shorter segment gets no corner in between, ...
constexpr double shortest_agile_split_s = 0.15;  ///< ... under a limit of thrust, with which ways are flown in far less

}  // namespace

template <class Family>
PlanChangesOf<Family>::PlanChangesOf(const PlannedFlights& flights, Random& random)
    : flights_(flights),
      space_(flights.task().space),
      random_(random),
      motion_(motion_limits_of(flights.task().problem)),
      tick_s_(1 / flights.task().problem.robot.controller.rate_hz) {}

template <class Family>
double PlanChangesOf<Family>::noise(double size) {
    // A sum of uniform numbers: bell-shaped, bounded, and the same on every machine.
    return size * (random_.uniform(-1, 1) + random_.uniform(-1, 1) + random_.uniform(-1, 1)) / 3;
}

template <class Family>
std::size_t PlanChangesOf<Family>::index_below(std::size_t count) {
    return static_cast<std::size_t>(random_.uniform(0, static_cast<double>(count)));
}

template <class Family>
void PlanChangesOf<Family>::shift(ReferencePoint& point, double step) {
    const double size_m = step * largest_shift_m;
    for (std::size_t i = 0; i < space_.axes().size(); ++i) {
        const SearchAxis& axis = space_.axes()[i];
        if (!axis.is_fixed()) {
            point.position[i] += noise(size_m / axis.weight_m);
        }
    }
}

template <class Family>
void PlanChangesOf<Family>::change_speed(ReferencePoint& point, double step) {
    const double share = step * largest_speed_change;
    for (std::size_t i = 0; i < space_.axes().size(); ++i) {
        const SearchAxis& axis = space_.axes()[i];
        if (!axis.is_fixed()) {
            point.velocity[i] += noise(share * axis.max_rate);
            point.acceleration[i] += noise(share * axis.max_acceleration);
        }
    }
}

template <class Family>
auto PlanChangesOf<Family>::draw(const Points& points, const std::vector<std::int64_t>& ticks, double step)
    -> std::optional<ChangedPoints> {
    std::optional<ChangedPoints> change = drawn(points, ticks, step);
    if (change) {
        Points& changed = change->points;
        const std::size_t last = changed.size() - 1;
        if (space_.looks_along()) {
            change->last_segment = last - 1;
        }
        // A point at which a segment begins that does not differ stays as it is.
        const std::size_t end = change->last_segment + 1 == last ? last : change->last_segment;
        for (std::size_t i = change->first_segment + 1; i <= end; ++i) {
            changed[i] = space_.looking(changed[i - 1], changed[i]);
        }
    }
    return change;
}

template <class Family>
auto PlanChangesOf<Family>::drawn(const Points& points, const std::vector<std::int64_t>& ticks, double step)
    -> std::optional<ChangedPoints> {
    const double kind = random_.uniform(0, 1);
    if (kind < moves_goal) {
        return with_goal_moved(points, step);
    }
    const bool has_corners = points.size() > 2;
    if (kind < moves_goal + adds_corner || !has_corners) {
        return with_corner_added(points, ticks, step);
    }
    return with_corner_changed(points, kind - moves_goal - adds_corner, step);
}

template <class Family>
auto PlanChangesOf<Family>::with_goal_moved(Points points, double step) -> std::optional<ChangedPoints> {
    const std::size_t last = points.size() - 1;
    const auto goal = flights_.goal().sample_near(configuration_of(points[last]), step * largest_shift_m, random_);
    if (!goal) {
        return std::nullopt;
    }
    points[last] = at_rest(space_.seen_from(configuration_of(points[last - 1]), *goal));
    return ChangedPoints{std::move(points), last - 1, last - 1};
}

template <class Family>
auto PlanChangesOf<Family>::with_corner_added(Points points, const std::vector<std::int64_t>& ticks, double step)
    -> std::optional<ChangedPoints> {
    const std::size_t i = index_below(ticks.size());
    const double shortest_s = motion_.max_thrust_ratio ? shortest_agile_split_s : shortest_split_s;
    if (static_cast<double>(ticks[i]) * tick_s_ < shortest_s) {
        return std::nullopt;
    }
    const auto at = static_cast<std::int64_t>(random_.uniform(0.2, 0.8) * static_cast<double>(ticks[i]));
    ReferencePoint corner = ReferenceSegment(points[i], points[i + 1], ticks[i], tick_s_).at_tick(at);
    shift(corner, step);
    change_speed(corner, step);
    points.insert(points.begin() + static_cast<std::ptrdiff_t>(i) + 1, corner);
    return ChangedPoints{std::move(points), i, i + 1};
}

/// @param kind in [0, 1 - moves_goal - adds_corner)
template <class Family>
auto PlanChangesOf<Family>::with_corner_changed(Points points, double kind, double step) -> ChangedPoints {
    const std::size_t corner = 1 + index_below(points.size() - 2);
    if (kind < leaves_corner_out) {
        points.erase(points.begin() + static_cast<std::ptrdiff_t>(corner));
        return {std::move(points), corner - 1, corner - 1};
    }
    kind -= leaves_corner_out;
    if (kind < flies_through) {
        fly_through(points, corner);
    } else if (kind < flies_through + moves_corner) {
        shift(points[corner], step);
    } else {
        if (kind < flies_through + moves_corner + moves_and_changes_speed) {
            shift(points[corner], step);
        }
        change_speed(points[corner], step);
    }
    return {std::move(points), corner - 1, corner};
}

/// Gives a corner a speed towards where the corners beside it lead.
template <class Family>
void PlanChangesOf<Family>::fly_through(Points& points, std::size_t corner) {
    const Configuration before = configuration_of(points[corner - 1]);
    const Configuration after = configuration_of(points[corner + 1]);
    const double per_metre = 1 / std::max(space_.travel_m(before, after), 1e-3);
    const double speed_m_s = random_.uniform(0, 1) * motion_.max_speed_m_s;
    ReferencePoint& p = points[corner];
    for (std::size_t i = 0; i < space_.axes().size(); ++i) {
        p.velocity[i] = speed_m_s * per_metre * (after[i] - before[i]);
        p.acceleration[i] = 0;
        if (const SearchAxis& axis = space_.axes()[i]; axis.group != AxisGroup::translation) {
            p.velocity[i] = std::clamp(p.velocity[i], -axis.max_rate, axis.max_rate);
        }
    }
}

template class PlanChangesOf<Plane>;
template class PlanChangesOf<Space>;

}  // namespace downwash::planning
