#pragma once

#include <ompl/base/Planner.h>

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "downwash/planner/flight_tree.hpp"
#include "downwash/planner/plan_refiner.hpp"
#include "downwash/planner/random.hpp"

namespace downwash::planning {

/// A plan that the planner's own model accepts, hold included.
struct Candidate {
    Plan plan;
    double cost;
    std::uint64_t iteration;
};

/// RRT* whose edges are closed-loop flights (variants MP-ARM-DA and MP-ARM-ADA): parents are chosen and nodes rewired
/// by flown cost. Samples come in waves, whose flights are flown side by side. What the tree finds is refined to plans
/// that do not stop at their corners; tree and refinement share the flight time equally. Anytime: the incumbent only
/// gets cheaper. The convergence theorem of RRT* assumes exact steering and is not claimed here.
class FlightTreePlanner : public ompl::base::Planner {
 public:
    /// @param accept asked about every better plan; false discards it and the search goes on
    FlightTreePlanner(const ompl::base::SpaceInformationPtr& information, const Problem& problem, FlightTree& tree,
                      const SearchSpace& space, PlannedFlights& flights, Random& random,
                      std::function<bool(const Candidate&)> accept);

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
    /// How near that is [m]; 0 within the goal region.
    [[nodiscard]] double nearest_distance_m() const noexcept { return nearest_distance_m_; }

 private:
    /// A sample on its way to become a node.
    struct Growth {
        Configuration to;
        std::vector<FlightNode*> neighbours;
        struct Parent {
            FlightNode* node;
            double estimate;
        };
        std::vector<Parent> parents;  ///< by estimate
        std::size_t next_parent = 0;
        std::optional<FlightTree::Flown> best;
        FlightNode* best_parent = nullptr;
    };

    void grow(std::uint64_t samples);
    [[nodiscard]] std::optional<Growth> sampled();
    void choose_parents(std::vector<Growth>& wave);
    [[nodiscard]] std::vector<FlightNode*> add(const std::vector<Growth>& wave);
    void rewire_through(const std::vector<Growth>& wave, const std::vector<FlightNode*>& added);
    [[nodiscard]] std::optional<Configuration> target();
    [[nodiscard]] std::optional<Configuration> target_beside_incumbent();
    void refine();
    void hand_to_refiner();
    [[nodiscard]] FlightNode* best_hold() const;
    [[nodiscard]] const FlightNode* other_way();
    [[nodiscard]] bool has_plan() const noexcept { return !tree_.holds().empty(); }
    void review(double least_gain);
    [[nodiscard]] std::size_t neighbour_count() const;

    FlightTree& tree_;
    const SearchSpace& space_;
    PlannedFlights& flights_;
    Random& random_;
    PlanRefiner refiner_;
    std::function<bool(const Candidate&)> accept_;
    std::function<void()> observer_;
    std::optional<std::uint64_t> max_iterations_;
    std::uint64_t iterations_ = 0;
    std::optional<Candidate> incumbent_;
    double best_hold_cost_ = HUGE_VAL;    ///< of the tree's holds
    double handed_over_cost_ = HUGE_VAL;  ///< of the tree's plan that the refiner got last
    std::uint64_t refine_ticks_ = 0;      ///< flown by the refiner
    int waves_since_review_ = 0;
    const FlightNode* nearest_to_goal_;
    double nearest_distance_m_;
    double range_m_;
};

}  // namespace downwash::planning
