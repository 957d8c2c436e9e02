#pragma once

#include <ompl/base/Planner.h>

#include <functional>
#include <optional>

#include "downwash/planner/flight_tree.hpp"
#include "downwash/planner/random.hpp"

namespace downwash::planning {

/// A plan that the planner's own model accepts, hold included.
struct Candidate {
    Plan plan;
    double cost;
    std::uint64_t iteration;
};

/// RRT* whose edges are closed-loop flights (variants MP-ARM-DA and MP-ARM-ADA): parents are chosen and nodes rewired
/// by flown cost. Anytime: the incumbent only gets cheaper. The convergence theorem of RRT* assumes exact steering and
/// is not claimed here.
class FlightTreePlanner : public ompl::base::Planner {
 public:
    /// @param accept asked about every better plan; false discards it and the search goes on
    FlightTreePlanner(const ompl::base::SpaceInformationPtr& information, FlightTree& tree, const SearchSpace& space,
                      Random& random, std::function<bool(const Candidate&)> accept);

    ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& terminated) override;
    void getPlannerData(ompl::base::PlannerData& data) const override;

    /// The search ends after so many iterations, whatever the termination condition says.
    void set_max_iterations(std::optional<std::uint64_t> iterations) { max_iterations_ = iterations; }
    /// Called after every iteration.
    void set_observer(std::function<void()> observer) { observer_ = std::move(observer); }

    [[nodiscard]] std::uint64_t iterations() const noexcept { return iterations_; }
    [[nodiscard]] const std::optional<Candidate>& incumbent() const noexcept { return incumbent_; }
    /// The node whose reference comes nearest to the goal.
    [[nodiscard]] const FlightNode& nearest_to_goal() const noexcept { return *nearest_to_goal_; }

 private:
    void grow();
    [[nodiscard]] std::optional<Configuration> target();
    [[nodiscard]] std::optional<Configuration> target_beside_incumbent();
    FlightNode* connect(const Configuration& to, const std::vector<FlightNode*>& neighbours);
    void rewire_through(FlightNode& node, std::vector<FlightNode*> neighbours);
    void try_hold(FlightNode& node);
    void review_holds(double least_gain);
    [[nodiscard]] std::size_t neighbour_count() const;

    FlightTree& tree_;
    const SearchSpace& space_;
    Random& random_;
    std::function<bool(const Candidate&)> accept_;
    std::function<void()> observer_;
    std::optional<std::uint64_t> max_iterations_;
    std::uint64_t iterations_ = 0;
    std::optional<Candidate> incumbent_;
    const FlightNode* best_hold_ = nullptr;  ///< where the incumbent came from; may have become cheaper since
    const FlightNode* nearest_to_goal_;
    double nearest_distance_m_;
    double range_m_;
};

}  // namespace downwash::planning
