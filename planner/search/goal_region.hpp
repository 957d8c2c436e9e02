#pragma once

#include <optional>

#include "downwash/search/random.hpp"
#include "downwash/search/search_space.hpp"

namespace downwash::planning {

/// Where a search leads: the goal of its problem, or one that a user of OMPL has written.
class GoalRegion {
 public:
    GoalRegion() = default;
    virtual ~GoalRegion() = default;
    GoalRegion(const GoalRegion&) = delete;
    GoalRegion& operator=(const GoalRegion&) = delete;

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

    /// Whether the rules of flights judge the hover, by the problem's goal; if not, is_met() does, at its end.
    [[nodiscard]] virtual bool is_of_problem() const noexcept = 0;
    /// Whether a vehicle that hovers has met the goal. @pre !is_of_problem()
    [[nodiscard]] virtual bool is_met(const FlightState& vehicle) const = 0;
};

/// The goal of a problem.
class ProblemGoal final : public GoalRegion {
 public:
    /// @param space must outlive it
    explicit ProblemGoal(const SearchSpace& space) : space_(space) {}

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
    [[nodiscard]] bool is_met(const FlightState&) const override { return true; }

 private:
    const SearchSpace& space_;
};

}  // namespace downwash::planning
