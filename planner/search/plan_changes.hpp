#pragma once

#include <optional>
#include <vector>

#include "downwash/search/planned_flights.hpp"
#include "downwash/search/random.hpp"

namespace downwash::planning {

/// The points of a reference after a change.
template <class Family>
struct ChangedPointsOf {
    using ReferencePoint = typename Family::ReferencePoint;

    std::vector<ReferencePoint> points;
    std::size_t first_segment, last_segment;  ///< the ones that differ, both included
};
using ChangedPoints = ChangedPointsOf<Plane>;

/// Draws random changes of a reference's points: what a pilot might try instead.
template <class Family>
class PlanChangesOf {
 public:
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using ReferenceSegment = typename Family::ReferenceSegment;
    using MotionLimits = typename Family::MotionLimits;
    using SearchSpace = typename Family::SearchSpace;
    using PlannedFlights = PlannedFlightsOf<Family>;
    using ChangedPoints = ChangedPointsOf<Family>;

    /// @param flights of the plans; they and `random` must outlive it
    PlanChangesOf(const PlannedFlights& flights, Random& random);

    /// One change, drawn at random; nothing when it cannot be made.
    /// @param points at least two; the first stays   @param ticks from each to the next
    /// @param step size of the change as a share of the largest, in (0, 1]
    [[nodiscard]] std::optional<ChangedPoints> draw(const std::vector<ReferencePoint>& points,
                                                    const std::vector<std::int64_t>& ticks, double step);

 private:
    using Points = std::vector<ReferencePoint>;
    [[nodiscard]] std::optional<ChangedPoints> drawn(const Points& points, const std::vector<std::int64_t>& ticks,
                                                     double step);
    [[nodiscard]] std::optional<ChangedPoints> with_goal_moved(Points points, double step);
    [[nodiscard]] std::optional<ChangedPoints> with_corner_added(Points points, const std::vector<std::int64_t>& ticks,
                                                                 double step);
    [[nodiscard]] ChangedPoints with_corner_changed(Points points, double kind, double step);
    void fly_through(Points& points, std::size_t corner);
    void shift(ReferencePoint& point, double step);
    void change_speed(ReferencePoint& point, double step);
    [[nodiscard]] double noise(double size);
    [[nodiscard]] std::size_t index_below(std::size_t count);

    const PlannedFlights& flights_;
    const SearchSpace& space_;
    Random& random_;
    MotionLimits motion_;
    double tick_s_;
};
using PlanChanges = PlanChangesOf<Plane>;

}  // namespace downwash::planning
