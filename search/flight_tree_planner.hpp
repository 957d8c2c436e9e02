#pragma once

#include <ompl/base/Planner.h>

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "downwash/search/flight_tree.hpp"
#include "downwash/search/plan_refiner.hpp"
#include "downwash/search/random.hpp"

namespace downwash::planning {

/// A plan that the planner's own model accepts, hold included.
struct Candidate {
    Plan plan;
    double cost;
    std::uint64_t iteration;
};

/// What a search asks about its plans.
struct CandidateHooks {
    /// Whether a plan counts, if need be after a direct flight; false discards it and the search goes on. Asked of one
    /// plan at a time, but on any thread and beside the search: it may touch nothing that the search works on.
    std::function<bool(const Candidate&)> counts;
    /// Told of every plan that counts, when the search takes it on; each is cheaper than the one before.
    std::function<void(const Candidate&)> accept;
};

/// RRT* whose edges are closed-loop flights (variants MP-ARM-DA and MP-ARM-ADA): parents are chosen and nodes rewired
/// by flown cost. Samples come in waves, whose flights are flown side by side. What the tree finds is refined to plans
/// that do not stop at their corners. Once there is a plan the search goes on in rounds, in which the tree grows, plans
/// are refined and the best one is flown directly, side by side; what each of them has found the others see after the
/// round. A round ends by what was flown in it, so threads change nothing but the time. Anytime: the incumbent only
/// gets cheaper. The convergence theorem of RRT* assumes exact steering and is not claimed here.
class FlightTreePlanner : public ompl::base::Planner {
 public:
    /// @param flights of the tree; those of the refiner are made like them
    /// @param threads that the search may use: those of `flights`
    FlightTreePlanner(const ompl::base::SpaceInformationPtr& information, const Problem& problem, FlightTree& tree,
                      const SearchSpace& space, PlannedFlights& flights, Random& random, CandidateHooks hooks,
                      int threads);

    ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& terminated) override;
    void getPlannerData(ompl::base::PlannerData& data) const override;

    /// The search ends after so many iterations, whatever the termination condition says.
    void set_max_iterations(std::optional<std::uint64_t> iterations) { max_iterations_ = iterations; }
    /// The search ends with the first plan that counts.
    void set_stops_at_first_plan(bool stops) { stops_at_first_plan_ = stops; }
    /// Called after every wave, or round.
    void set_observer(std::function<void()> observer) { observer_ = std::move(observer); }

    [[nodiscard]] std::uint64_t iterations() const noexcept { return iterations_; }
    [[nodiscard]] const std::optional<Candidate>& incumbent() const noexcept { return incumbent_; }
    /// The node whose reference comes nearest to the goal.
    [[nodiscard]] const FlightNode& nearest_to_goal() const noexcept { return *nearest_to_goal_; }
    /// How near that is [m]; 0 within the goal region.
    [[nodiscard]] double nearest_distance_m() const noexcept { return nearest_distance_m_; }
    /// Of everything that was flown in the planner's own model.
    [[nodiscard]] FlightStatistics statistics() const;

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

    /// A plan on its way to become the incumbent, of the refiner or of the tree, as it was flown.
    struct Proposal {
        Candidate candidate;
        std::vector<FlightState> states;  ///< at the plan's knots, and after the hold
        int refined = 0;                  ///< number of the refiner's plan, or
        FlightNode* hold = nullptr;       ///< of the tree
        bool is_good = false;             ///< it counts
    };

    void grow();
    [[nodiscard]] std::optional<Growth> sampled();
    void choose_parents(std::vector<Growth>& wave);
    [[nodiscard]] std::vector<FlightNode*> add(const std::vector<Growth>& wave);
    void rewire_through(const std::vector<Growth>& wave, const std::vector<FlightNode*>& added);
    [[nodiscard]] std::optional<Configuration> target();
    [[nodiscard]] std::optional<Configuration> target_beside_incumbent();
    void refine();
    void go_on_side_by_side(const ompl::base::PlannerTerminationCondition& terminated);
    void hand_to_refiner();
    [[nodiscard]] FlightNode* best_hold() const;
    [[nodiscard]] const FlightNode* other_way();
    /// Whether there is a plan, of the tree or the incumbent, that was not discarded.
    [[nodiscard]] bool has_plan() const noexcept { return incumbent_ || best_hold_cost_ < HUGE_VAL; }
    void note_best_hold();
    [[nodiscard]] bool is_used_up() const noexcept { return max_iterations_ && iterations_ >= *max_iterations_; }
    [[nodiscard]] std::optional<Proposal> proposal(double least_gain) const;
    void fly(Proposal& proposal) const;
    void settle(Proposal proposal);
    void settle_best(const ompl::base::PlannerTerminationCondition& terminated);
    [[nodiscard]] double work_beside(const Plan& plan) const;
    [[nodiscard]] std::size_t neighbour_count() const;

    FlightTree& tree_;
    const SearchSpace& space_;
    PlannedFlights& flights_;         ///< of the tree
    PlannedFlights refined_flights_;  ///< of the refiner
    Random& random_;                  ///< of the tree, and between rounds
    Random refiner_random_;
    PlanRefiner refiner_;
    CandidateHooks hooks_;
    int threads_;
    std::function<void()> observer_;
    std::optional<std::uint64_t> max_iterations_;
    bool stops_at_first_plan_ = false;
    std::uint64_t iterations_ = 0;
    std::optional<Candidate> incumbent_;
    std::vector<Plan> handed_over_;       ///< the refiner takes them on in the next round
    double best_hold_cost_ = HUGE_VAL;    ///< of the tree's holds that were not discarded
    double handed_over_cost_ = HUGE_VAL;  ///< of the tree's plan that the refiner got last
    double tree_left_ = 0;                ///< work in this round; below 0 what was done too much
    double refiner_left_ = 0;             ///< the same of the refiner
    const FlightNode* nearest_to_goal_;
    double nearest_distance_m_;
    double range_m_;
};

}  // namespace downwash::planning
