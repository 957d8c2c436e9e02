#pragma once

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/base/samplers/InformedStateSampler.h>

#include <mutex>

#include "downwash/search/goal_region.hpp"
#include "downwash/search/place_sampler.hpp"
#include "downwash/search/search_objective.hpp"

// What users of OMPL may replace, as our search sees it. States are those of a flight space (flight_space.hpp).

namespace downwash::planning {

/// The state sampler of a space and, under a user's objective, its informed sampler.
class OmplSampler final : public PlaceSampler {
 public:
    /// @param informed nullptr: none
    OmplSampler(const ompl::base::SpaceInformationPtr& information, const SearchTask& task,
                ompl::base::InformedSamplerPtr informed);

    [[nodiscard]] std::optional<Configuration> anywhere(double most) override;
    [[nodiscard]] Configuration near(const Configuration& place, double radius_m) override;

 private:
    const SearchTask& task_;
    ompl::base::ScopedState<> state_, beside_;
    ompl::base::StateSamplerPtr sampler_;
    ompl::base::InformedSamplerPtr informed_;
};

/// A goal that a user has written. Asked by one thread at a time.
class OmplGoal final : public GoalRegion {
 public:
    OmplGoal(const ompl::base::SpaceInformationPtr& information, const SearchTask& task,
             const ompl::base::GoalSampleableRegion& goal);

    [[nodiscard]] std::optional<Configuration> sample(Random& random) const override;
    [[nodiscard]] std::optional<Configuration> sample_near(const Configuration& configuration, double radius_m,
                                                           Random& random) const override;
    /// The configuration itself: a user's region has no tolerance to be used up.
    [[nodiscard]] Configuration moved_into(const Configuration& configuration, double) const override {
        return configuration;
    }
    [[nodiscard]] double distance_m(const Configuration& configuration) const override;
    [[nodiscard]] bool contains(const Configuration& configuration) const override;
    [[nodiscard]] bool is_of_problem() const noexcept override { return false; }
    [[nodiscard]] bool is_met(const FlightState& vehicle) const override;

 private:
    const SearchTask& task_;
    const ompl::base::GoalSampleableRegion& goal_;
    mutable std::mutex mutex_;
    mutable ompl::base::ScopedState<> state_;
};

/// An objective that a user has written. Asked by one thread at a time.
class OmplObjective final : public SearchObjective {
 public:
    /// @param goal to which costs to go are asked for
    OmplObjective(const ompl::base::SpaceInformationPtr& information, const SearchTask& task,
                  const ompl::base::OptimizationObjective& objective, const ompl::base::Goal& goal);

    [[nodiscard]] double of_leg(const FlightState& from, const FlightLeg& leg) const override;
    [[nodiscard]] double estimate(const Configuration& from, const Configuration& to) const override;
    [[nodiscard]] double min_to_goal(const Configuration& from) const override;

 private:
    const SearchTask& task_;
    const ompl::base::OptimizationObjective& objective_;
    const ompl::base::Goal& goal_;
    mutable std::mutex mutex_;
    mutable ompl::base::ScopedState<> from_, to_;
};

/// Whether costs of an objective add up, and less is better, as a search needs it.
[[nodiscard]] bool is_additive(const ompl::base::OptimizationObjective& objective);

}  // namespace downwash::planning
