#pragma once

#include <ompl/base/Planner.h>

#include <memory>
#include <vector>

#include "downwash/search/flight_tree_search.hpp"
#include "downwash/search/ompl_parts.hpp"

namespace downwash::planning {

/// The search of FlightTreeSearch as a planner of OMPL.
///
/// Keeps the contract of ompl::base::Planner. States are moments of flights (see flight_space.hpp). Places are drawn by
/// the space's state sampler, goals by whatever GoalSampleableRegion the problem definition has, and costs are those of
/// its objective if they add up; under a user's objective its informed sampler draws, too. solve() continues
/// with the tree there is; after clear() it does again what it did the first time. Numbers are parameters by the names
/// that algorithms() lists for rrt-star; params() sets them.
class FlightTreePlanner : public ompl::base::Planner {
 public:
    /// @param information of make_flight_space() for the same task; solve() wants one start
    /// @param task gives seed and parameters too; must outlive the planner
    /// @param threads that the search may use, at least 1; the result does not depend on it
    FlightTreePlanner(const ompl::base::SpaceInformationPtr& information, const SearchTask& task, int threads = 1);

    void setup() override;
    void clear() override;
    ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& terminated) override;
    /// Nodes of the tree; the ends of the hovers at the goal are the goal vertices.
    void getPlannerData(ompl::base::PlannerData& data) const override;

    [[nodiscard]] FlightTreeSearch& search() noexcept { return search_; }
    [[nodiscard]] const FlightTreeSearch& search() const noexcept { return search_; }

    /// Whether it searches for a goal that is not the task's.
    [[nodiscard]] bool has_users_goal() const noexcept { return users_goal_ != nullptr; }

 protected:
    /// A solution as the planner hands it to its problem definition.
    [[nodiscard]] virtual ompl::base::PathPtr make_path(const std::vector<FlightPoint>& moments) const;

 private:
    [[nodiscard]] bool adopt_goal();
    [[nodiscard]] bool adopt_objective();
    ompl::base::PlannerStatus report_solution();

    const SearchTask& task_;
    FlightTreeSearch search_;
    std::unique_ptr<OmplGoal> users_goal_;            ///< nullptr: the goal is the task's
    std::unique_ptr<OmplObjective> users_objective_;  ///< nullptr: the objective is the task's
    std::unique_ptr<OmplSampler> sampler_;
};

}  // namespace downwash::planning
