#pragma once

#include <optional>
#include <span>
#include <vector>

#include "downwash/controllers/configuration.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/search/family.hpp"
#include "downwash/search/query_counts.hpp"
#include "downwash/search/random.hpp"
#include "downwash/simulation/flight.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::planning {

/// The reference at the start of a problem: the one point of a plan that may move.
[[nodiscard]] ReferencePoint reference_at(const Start& start) noexcept;

/// Where a problem begins.
[[nodiscard]] inline Configuration place_of(const Start& start) noexcept {
    return start.at;
}

/// The point at the share s of the straight line from a to b, angles taken as they stand.
template <class Configuration>
[[nodiscard]] Configuration between(const Configuration& a, const Configuration& b, double s) noexcept {
    Configuration c;
    for (std::size_t axis = 0; axis < c.coordinate.size(); ++axis) {
        c[axis] = a[axis] + s * (b[axis] - a[axis]);
    }
    return c;
}

/// Peak over mean speed of the rest-to-rest reference: no motion, however divided, takes less beyond its way over the
/// top speed.
inline constexpr double peak_over_mean_speed = 15.0 / 8.0;

/// An axis as a search sees it.
struct SearchAxis {
    AxisGroup group;
    double low, high;                   ///< its values; of an axis that wraps one turn of them [m or rad]
    double weight_m;                    ///< metres that a unit of it counts for in distances
    bool wraps;                         ///< values a turn apart are the same place
    double reach_m;                     ///< no point of the robot moves farther as the value changes by one unit
    double max_rate, max_acceleration;  ///< of references; of translations that of all together

    /// Whether there is but one value.
    [[nodiscard]] bool is_fixed() const noexcept { return low == high; }
};

/// What the spaces of configurations of both families have in common: their axes, samples, and ways along axes.
template <class Family>
class SearchAxesOf {
 public:
    using Configuration = typename Family::Configuration;

    /// The axes in the order of a configuration's coordinates.
    [[nodiscard]] std::span<const SearchAxis> axes() const noexcept { return axes_; }

    /// Indices of the axes that are translations.
    [[nodiscard]] std::span<const std::size_t> translations() const noexcept { return translations_; }

    /// The way from one value of an axis to another [m or rad]: the shorter one where the axis wraps.
    [[nodiscard]] double way(std::size_t axis, double from, double to) const noexcept;

    /// `to` with the angles that wrap unwrapped so that they are reached from `from` by the shorter turn.
    [[nodiscard]] Configuration seen_from(const Configuration& from, Configuration to) const noexcept;

    /// Straight distance of the vehicle's positions [m].
    [[nodiscard]] double travel_m(const Configuration& a, const Configuration& b) const noexcept;

    /// A configuration within the bounds.
    [[nodiscard]] Configuration sample(Random& random) const;

    /// A configuration within the bounds, at most `radius_m` beside another in each coordinate.
    [[nodiscard]] Configuration sample_near(const Configuration& configuration, double radius_m, Random& random) const;

    /// Which limit a configuration leaves: `bounds`, `arm_limits`, or `none`.
    [[nodiscard]] Rejection limit_left_at(const Configuration& configuration) const noexcept;
    [[nodiscard]] bool is_inside(const Configuration& configuration) const noexcept {
        return limit_left_at(configuration) == Rejection::none;
    }

 protected:
    explicit SearchAxesOf(std::vector<SearchAxis> axes);
    ~SearchAxesOf() = default;

 private:
    std::vector<SearchAxis> axes_;
    std::vector<std::size_t> translations_;
};

/// The space of configurations of one problem: distances, samples, goals and collisions of the level vehicle.
class SearchSpace : public SearchAxesOf<Plane> {
 public:
    SearchSpace(const Problem& problem, const FlightModel& model);

    [[nodiscard]] const Goal& goal() const noexcept { return goal_; }

    /// Metres that one radian of the arm counts for: half the arm's length.
    [[nodiscard]] double arm_weight_m() const noexcept { return arm_weight_m_; }

    /// The largest turn of any joint between two configurations [rad], >= 0.
    [[nodiscard]] double turn_rad(const Configuration& from, const Configuration& to) const noexcept;

    /// The square root of the weighted squares of the ways along all axes [m]: sqrt(dx^2 + dz^2 + (w darm)^2).
    [[nodiscard]] double distance_m(const Configuration& a, const Configuration& b) const noexcept;

    /// In the plane nothing looks anywhere.
    [[nodiscard]] const ReferencePoint& looking(const ReferencePoint& /*before*/,
                                                const ReferencePoint& point) const noexcept {
        return point;
    }
    [[nodiscard]] bool looks_along() const noexcept { return false; }

    /// What a way counts in costs that count length: distance_m().
    [[nodiscard]] double length_m(const Configuration& a, const Configuration& b) const noexcept {
        return distance_m(a, b);
    }

    /// The square of distance_m() [m2], or some smaller number of at least `enough_m2`.
    [[nodiscard]] double squared_distance_m2(const Configuration& a, const Configuration& b,
                                             double enough_m2) const noexcept;

    /// The point at most `range_m` from `from` on the straight line towards `to`.
    [[nodiscard]] Configuration steered(const Configuration& from, const Configuration& to, double range_m) const;

    /// A configuration of the level vehicle that meets the goal, free of collision: inverse kinematics with the arm in
    /// any direction that the goal leaves open, so both branches of the arm occur; alternatives come in random order.
    /// Nothing after some failed tries.
    [[nodiscard]] std::optional<Configuration> sample_goal(Random& random) const;

    /// A configuration beside one that meets the goal, which meets it too: what the goal leaves free is moved. Nothing
    /// when that collides.
    [[nodiscard]] std::optional<Configuration> sample_goal_near(const Configuration& configuration, double radius_m,
                                                                Random& random) const;

    /// The configuration nearest to another that uses up at most so much of each of the goal's tolerances; what the
    /// goal leaves free is kept. Of alternatives the nearest. May collide.
    /// @param share of the tolerances, 0 to 1; 0 is the middle of the goal
    [[nodiscard]] Configuration moved_into_goal(Configuration configuration, double share) const;

    /// Goal error of the level vehicle.
    [[nodiscard]] GoalError error(const Configuration& configuration) const;

    /// For how long the goal is held there [s]; of several alternatives the nearest one's hold.
    [[nodiscard]] double hold_s(const Configuration& configuration) const;

    /// Whether the level vehicle there is so near the goal that a flight to it may well meet the goal: within the
    /// usable share of each tolerance.
    [[nodiscard]] bool is_near_goal(const Configuration& configuration) const;

    /// By how much the error from one of the goal's alternatives exceeds the usable share of each tolerance.
    [[nodiscard]] GoalError error_beyond_tolerance(const Goal& goal, const Configuration& configuration) const;

    /// Distance and angle to the goal as one length [m], 0 inside the goal region; of alternatives to the nearest.
    [[nodiscard]] double goal_distance_m(const Configuration& configuration) const;

    /// What forbids the vehicle there, level if no pitch is given: `bounds`, `arm_limits`, `collision` with the safety
    /// margin, or `none`.
    [[nodiscard]] Rejection rejection_at(const Configuration& configuration, double pitch_rad = 0) const;
    [[nodiscard]] bool is_valid(const Configuration& configuration) const {
        return rejection_at(configuration) == Rejection::none;
    }

    /// What forbids the vehicle in a pose there.
    [[nodiscard]] Rejection rejection_at(const Configuration& configuration, const PlanarPose& pose) const;

    /// The pose of a vehicle at a point of a reference: level or, if it tilts as the reference asks, with its pitch.
    [[nodiscard]] PlanarPose pose_along(const ReferencePoint& point, bool tilts) const;

    /// For how many ticks a point is held as the goal.
    [[nodiscard]] std::int64_t hold_ticks(const ReferencePoint& at) const;
    /// Whether a vehicle meets the goal now: within its tolerances, and slow.
    [[nodiscard]] bool is_met(const FlightState& vehicle) const;

    /// Whether nothing forbids the level vehicle there; counts the query and what came of it.
    [[nodiscard]] bool is_allowed(const Configuration& configuration, QueryCounts& counts) const;

    /// Largest distance between two configurations [m].
    [[nodiscard]] double extent_m() const noexcept;

 private:
    [[nodiscard]] Configuration moved_to(const Goal& goal, Configuration configuration, Random& random) const;
    [[nodiscard]] Configuration moved_into(const Goal& goal, Configuration configuration, double share) const;
    /// A direction of the arm as an angle within its limits, of several the one nearest to another angle; where none is
    /// within, and without limits, the least that is no smaller than the low end of its range.
    [[nodiscard]] double into_arm_range(double arm_rad, double near_rad) const noexcept;

    const FlightModel& model_;
    Goal goal_;
    double arm_weight_m_;
    double margin_m_;
};

}  // namespace downwash::planning
