#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "downwash/base/space_bounds.hpp"
#include "downwash/search/fleet.hpp"
#include "downwash/simulation/flight_batch.hpp"
#include "downwash/simulation/space_goal_rule.hpp"
#include "downwash/simulation/space_pool.hpp"

// What braking asks of each family: where a vehicle can come to rest, and how it flies there. Both have the same
// members.

namespace downwash::planning {

/// For how long a stop hovers before it counts [s].
inline constexpr double stop_hold_s = 4;

/// One way to brake. Distances are those of a constant deceleration, times a factor.
struct Maneuver {
    double harder;      ///< limits of acceleration and jerk, over those of the problem
    double farther;     ///< distance
    double up_m;        ///< besides
    double left_m = 0;  ///< of the way, horizontally; in space
};

/// The world in which everything is nominal, for flights.
[[nodiscard]] inline const FlownWorld* nominal_world_of(const FlightModel& model) noexcept {
    return &model.nominal_world();
}
[[nodiscard]] inline const SpaceWorld* nominal_world_of(const SpaceProblemModel& /*model*/) noexcept {
    return nullptr;
}

/// A flight that has not begun.
[[nodiscard]] inline FlightJob job_from(const FlightState& vehicle, const FlownWorld* world) {
    return {vehicle, {}, 0, world};
}
[[nodiscard]] inline SpaceFlightJob job_from(const AnySpaceState& vehicle, const SpaceWorld* world) {
    return {vehicle, {}, world};
}

/// A vehicle at the start of a flight in some world: it was always in this state.
[[nodiscard]] FlightState begun_in(FlightState vehicle, const FlownWorld* world);
[[nodiscard]] AnySpaceState begun_in(AnySpaceState vehicle, const SpaceWorld* world);

template <class Family>
class BrakingPartsOf;

template <>
class BrakingPartsOf<Plane> {
 public:
    /// A map of the planner's own model around some places of the vehicle; nullptr: surfaces do not act.
    using MapAround = std::function<std::shared_ptr<const AeroMap>(const Bounds& places)>;
    using Hover = Goal;

    /// @pre problem and model outlive it
    BrakingPartsOf(const Problem& problem, const FlightModel& model, MapAround map_around, int threads);

    /// The gentle ones first, then those that get out of the way of something.
    [[nodiscard]] static std::span<const Maneuver> maneuvers() noexcept;
    [[nodiscard]] MotionLimits limits_of(const Maneuver& maneuver) const;
    /// Where a reference comes to rest. @param limits of the maneuver
    [[nodiscard]] Configuration rest_of(const ReferencePoint& from, const MotionLimits& limits,
                                        const Maneuver& maneuver) const;
    [[nodiscard]] bool is_inside(const Configuration& at) const;
    /// Whether the level vehicle there is nearer to an obstacle.
    [[nodiscard]] bool is_nearer_than(const Configuration& at, double margin_m) const;
    /// The margin of the problem, if the vehicle has it.
    [[nodiscard]] double kept_margin_m(const FlightState& vehicle) const;
    [[nodiscard]] Configuration place_of(const FlightState& vehicle) const;

    /// A hover there: it may be a little beside it, but has to come to rest.
    [[nodiscard]] Hover hover_at(const Configuration& rest) const;
    [[nodiscard]] Plan with_hover(const Plan& plan, const Hover& hover) const;

    /// Completes a job that ends with a hover. @param margin_m that it keeps; below 0: none
    void judge(FlightJob& job, const Hover& hover, double margin_m) const;
    /// Later flights are with a map around these places.
    void fly_around(std::span<const Configuration> places);
    void fly(std::span<FlightJob> jobs) { pool_->fly(jobs); }
    /// Whether a flight is not safe. In the nominal world it comes to rest and keeps a margin, in another one the
    /// vehicle may still be settling.
    [[nodiscard]] static bool fails(const FlightJob& job, bool is_nominal, double margin_m);

 private:
    const Problem& problem_;
    const FlightModel& model_;
    MapAround map_around_;
    int threads_;
    std::shared_ptr<const AeroMap> map_;
    std::unique_ptr<FlightPool> pool_;  ///< flights with the map; nothing before the first flight
};

template <>
class BrakingPartsOf<Space> {
 public:
    /// Volumes fill themselves wherever a flight asks; nullptr: surfaces do not act.
    using MapAround = std::function<std::shared_ptr<const SurfaceVolumes>()>;
    using Hover = std::shared_ptr<const SpaceGoalRule>;

    /// See BrakingPartsOf<Plane>, for all members.
    BrakingPartsOf(const SpaceProblem& problem, const SpaceProblemModel& model, MapAround map_around, int threads);

    [[nodiscard]] static std::span<const Maneuver> maneuvers() noexcept;
    [[nodiscard]] SpaceMotionLimits limits_of(const Maneuver& maneuver) const;
    [[nodiscard]] SpaceConfiguration rest_of(const SpacePoint& from, const SpaceMotionLimits& limits,
                                             const Maneuver& maneuver) const;
    [[nodiscard]] bool is_inside(const SpaceConfiguration& at) const;
    [[nodiscard]] bool is_nearer_than(const SpaceConfiguration& at, double margin_m) const;
    [[nodiscard]] double kept_margin_m(const AnySpaceState& vehicle) const;
    [[nodiscard]] SpaceConfiguration place_of(const AnySpaceState& vehicle) const;

    [[nodiscard]] Hover hover_at(const SpaceConfiguration& rest) const;
    [[nodiscard]] SpacePlan with_hover(const SpacePlan& plan, const Hover& hover) const;

    void judge(SpaceFlightJob& job, const Hover& hover, double margin_m) const;
    void fly_around(std::span<const SpaceConfiguration> places);
    void fly(std::span<SpaceFlightJob> jobs) { pool_->fly(jobs); }
    [[nodiscard]] static bool fails(const SpaceFlightJob& job, bool is_nominal, double margin_m);

 private:
    const SpaceProblem& problem_;
    const SpaceProblemModel& model_;
    MapAround map_around_;
    int threads_;
    std::shared_ptr<const SurfaceVolumes> map_;
    std::unique_ptr<SpacePool> pool_;
};

}  // namespace downwash::planning
