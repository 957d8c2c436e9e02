#pragma once

#include <optional>

#include "downwash/search/random.hpp"
#include "downwash/search/search_task.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {

/// Where a search leads: the goal of its problem, or one that a user of OMPL has written.
template <class Family>
class GoalRegionOf {
 public:
    using Configuration = typename Family::Configuration;
    using FlightState = typename Family::FlightState;

    GoalRegionOf() = default;
    virtual ~GoalRegionOf() = default;
    GoalRegionOf(const GoalRegionOf&) = delete;
    GoalRegionOf& operator=(const GoalRegionOf&) = delete;

    /// A configuration of the level vehicle in the region, free of collision; nothing after some failed tries.
    [[nodiscard]] virtual std::optional<Configuration> sample(Random& random) const = 0;
    /// Another one beside one in the region, at most about `radius_m` away; nothing when none is found.
    [[nodiscard]] virtual std::optional<Configuration> sample_near(const Configuration& configuration, double radius_m,
                                                                   Random& random) const = 0;
    /// The configuration nearest to another that uses up at most this share of the region's tolerance. May collide.
    [[nodiscard]] virtual Configuration moved_into(const Configuration& configuration, double share) const = 0;
    /// How far a configuration is from the region [m]; 0 inside.
    [[nodiscard]] virtual double distance_m(const Configuration& configuration) const = 0;
    /// Whether a flight to a configuration may well meet the goal.
    [[nodiscard]] virtual bool contains(const Configuration& configuration) const = 0;

    /// Whether it is the problem's: then the rules of flights judge the whole hover; otherwise is_met() does, at its
    /// end.
    [[nodiscard]] virtual bool is_of_problem() const noexcept = 0;
    /// Whether a vehicle meets the goal now: in the region, and slow.
    [[nodiscard]] virtual bool is_met(const FlightState& vehicle) const = 0;
};
using GoalRegion = GoalRegionOf<Plane>;

/// The goal of a problem.
template <class Family>
class ProblemGoalOf final : public GoalRegionOf<Family> {
 public:
    using Configuration = typename Family::Configuration;
    using FlightState = typename Family::FlightState;
    using SearchSpace = typename Family::SearchSpace;
    using SearchTask = SearchTaskOf<Family>;

    /// @param task must outlive it
    explicit ProblemGoalOf(const SearchTask& task) : space_(task.space) {}

    [[nodiscard]] std::optional<Configuration> sample(Random& random) const override {
        return space_.sample_goal(random);
    }
    [[nodiscard]] std::optional<Configuration> sample_near(const Configuration& configuration, double radius_m,
                                                           Random& random) const override {
        return space_.sample_goal_near(configuration, radius_m, random);
    }
    [[nodiscard]] Configuration moved_into(const Configuration& configuration, double share) const override {
        return space_.moved_into_goal(configuration, share);
    }
    [[nodiscard]] double distance_m(const Configuration& configuration) const override {
        return space_.goal_distance_m(configuration);
    }
    [[nodiscard]] bool contains(const Configuration& configuration) const override {
        return space_.is_near_goal(configuration);
    }
    [[nodiscard]] bool is_of_problem() const noexcept override { return true; }
    [[nodiscard]] bool is_met(const FlightState& vehicle) const override { return space_.is_met(vehicle); }

 private:
    const SearchSpace& space_;
};
using ProblemGoal = ProblemGoalOf<Plane>;

}  // namespace downwash::planning
