#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "downwash/search/kept_yaw.hpp"
#include "downwash/search/random.hpp"
#include "downwash/search/search_space.hpp"
#include "downwash/simulation/space_goal_rule.hpp"
#include "downwash/simulation/space_goal_sampler.hpp"
#include "downwash/simulation/space_place.hpp"

namespace downwash::planning {

/// Where a problem begins.
[[nodiscard]] inline SpaceConfiguration place_of(const SpaceStart& start) noexcept {
    return configuration_of(reference_at(start));
}

/// The space of configurations of one problem in space: distances, samples, goals and collisions of the level vehicle.
/// The vehicle can be turned and moved to any place, so a goal binds no more than the arm's joints and the heading.
class SpaceSearchSpace : public SearchAxesOf<Space> {
 public:
    /// @param problem its first goal is that of the search   @param model must outlive it
    SpaceSearchSpace(const SpaceProblem& problem, const SpaceProblemModel& model);

    [[nodiscard]] const SpaceGoal& goal() const noexcept { return rule_.goals().front(); }
    /// That goal for flights.
    [[nodiscard]] const SpaceGoalRule& goal_rule() const noexcept { return rule_; }

    /// How long the rest-to-rest reference between two configurations takes [s], angles by the shorter turn: a metric
    /// without weights.
    [[nodiscard]] double duration_s(const Configuration& from, const Configuration& to) const noexcept;

    /// How long the way takes at the limits of speed, without accelerating [s].
    [[nodiscard]] double duration_at_limits_s(const Configuration& from, const Configuration& to) const noexcept;

    /// duration_s() as a length: the way at top speed of a reference that takes so long at its mean speed [m].
    [[nodiscard]] double distance_m(const Configuration& a, const Configuration& b) const noexcept;
    /// What a way counts in costs that count length: that of the multirotor's centre of mass.
    [[nodiscard]] double length_m(const Configuration& a, const Configuration& b) const noexcept {
        return travel_m(a, b);
    }
    /// The square of distance_m() [m2].
    [[nodiscard]] double squared_distance_m2(const Configuration& a, const Configuration& b,
                                             double enough_m2) const noexcept;

    /// A point on the straight line from `from` towards `to`: `to`, or one about `range_m` away.
    [[nodiscard]] Configuration steered(const Configuration& from, const Configuration& to, double range_m) const;

    /// A configuration within the bounds with the joints as at the start.
    [[nodiscard]] Configuration sample_in_transport(Random& random) const;

    /// See SearchSpace. In problems with an uncertainty the one of some samples that suits worlds best.
    [[nodiscard]] std::optional<Configuration> sample_goal(Random& random) const;
    [[nodiscard]] std::optional<Configuration> sample_goal_near(const Configuration& configuration, double radius_m,
                                                                Random& random) const;
    /// The same configuration where no nearer one is found.
    [[nodiscard]] Configuration moved_into_goal(Configuration configuration, double share) const;
    [[nodiscard]] SpaceGoalError error(const Configuration& configuration) const;
    [[nodiscard]] std::int64_t hold_ticks(const SpacePoint& at) const;
    [[nodiscard]] double hold_s(const Configuration& configuration) const;
    [[nodiscard]] bool is_near_goal(const Configuration& configuration) const;
    [[nodiscard]] double goal_distance_m(const Configuration& configuration) const;
    [[nodiscard]] bool is_met(const AnySpaceState& vehicle) const;

    /// What a way from a configuration to an alternative of the goal takes at least.
    struct Approach {
        double length_m;              ///< of the vehicle's way
        double duration_at_limits_s;  ///< see above
        double hold_s;
    };
    [[nodiscard]] std::vector<Approach> approaches(const Configuration& from) const;

    /// A point as it looks after another one; see KeptYaw.
    [[nodiscard]] SpacePoint looking(const SpacePoint& before, const SpacePoint& point) const;
    /// Whether how a point looks depends on the points before.
    [[nodiscard]] bool looks_along() const noexcept { return yaw_.depends_on_way(); }

    /// What forbids the level vehicle there, or a vehicle in a pose: `bounds`, `arm_limits`, `collision` with the
    /// safety margin, or `none`.
    [[nodiscard]] Rejection rejection_at(const Configuration& configuration) const {
        return rejection_at(configuration, level_at(configuration));
    }
    [[nodiscard]] Rejection rejection_at(const Configuration& configuration, const SpacePose& pose) const;
    [[nodiscard]] bool is_valid(const Configuration& configuration) const {
        return rejection_at(configuration) == Rejection::none;
    }
    /// Whether the level vehicle keeps the safety margin there and so much more.
    [[nodiscard]] bool has_room(const Configuration& configuration, double more_m) const;

    /// See SearchSpace.
    [[nodiscard]] bool is_allowed(const Configuration& configuration, QueryCounts& counts) const;

    /// The pose of a vehicle at a point of a reference: level or, if it tilts as the reference asks, along a + g.
    [[nodiscard]] SpacePose pose_along(const SpacePoint& point, bool tilts) const;

    /// Largest distance between two configurations [m].
    [[nodiscard]] double extent_m() const noexcept;

 private:
    [[nodiscard]] std::optional<Configuration> drawn_at_goal(Random& random) const;
    [[nodiscard]] std::optional<Configuration> nearest_at_goal(const Configuration& to, double share,
                                                               bool may_have_flaws) const;

    const SpaceProblemModel& model_;
    SpaceGoalRule rule_;
    SpaceGoalSampler sampler_;
    KeptYaw yaw_;
    SpaceMotionLimits limits_;
    Configuration start_;
    double margin_m_;
    double reach_m_;       ///< of the robot, from its multirotor's centre of mass
    double tool_reach_m_;  ///< of its end effector at most, from there
};

}  // namespace downwash::planning
