#pragma once

#include <ompl/base/Planner.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "downwash/base/parallel.hpp"
#include "downwash/search/flight_tree_parameters.hpp"
#include "downwash/search/ompl_parts.hpp"
#include "downwash/search/plan_refiner.hpp"
#include "downwash/search/random.hpp"
#include "downwash/search/tree_growth.hpp"

namespace downwash::planning {

/// A plan that the planner's own model accepts, with the hover at the goal.
struct Candidate {
    std::vector<FlightPoint> moments;  ///< moments at the plan's knots, then after the hover
    double cost = 0;
    std::uint64_t iteration = 0;
};

/// What a search asks about its plans. Without functions every plan counts.
struct CandidateHooks {
    /// Executes a plan, if need be, and says whether it counts; false discards it and the search goes on. Called with
    /// one plan at a time, but on any thread and beside the search: it may touch nothing that the search works on.
    std::function<bool(const Candidate&)> survives_execution = {};
    /// The worlds in which the last plan failed that did not survive, if the search may learn from them.
    std::function<std::vector<Counterexample>()> counterexamples = {};
    /// Told of every plan that counts, when the search takes it on; each is cheaper than the one before.
    std::function<void(const Candidate&)> accept = {};
};

/// RRT* whose edges are lines or closed-loop flights, as the variant has them (edge_flights.hpp): parents are chosen
/// and nodes rewired by the cost of what was flown. Samples come in batches, whose edges are flown side by side. What
/// the tree finds is refined to plans that do not stop at their corners. Once there is a plan the search goes on in
/// rounds, in which the tree grows, plans are refined and the best one is executed, side by side; what each of them has
/// found the others see after the round. A round ends by the work done in it, so threads change nothing but the time.
/// Anytime: the best plan only gets cheaper. The convergence theorem of RRT* assumes exact steering and is not claimed
/// here.
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

    void set_hooks(CandidateHooks hooks) { hooks_ = std::move(hooks); }
    /// The search ends after so many iterations since the last clear(), whatever the termination condition says.
    void set_max_iterations(std::optional<std::uint64_t> iterations) { max_iterations_ = iterations; }
    /// The search ends with the first plan that counts.
    void set_stops_at_first_plan(bool stops) { stops_at_first_plan_ = stops; }
    /// What is known before the next search that begins: see SolveOptions.
    void set_known(std::optional<Plan> plan, std::vector<Configuration> places) {
        known_plan_ = std::move(plan);
        known_places_ = std::move(places);
    }
    /// Called after every batch, or round, before its plans are executed.
    void set_observer(std::function<void()> observer) { observer_ = std::move(observer); }

    /// Whether the condition of the solve() under way says that it has to end.
    [[nodiscard]] bool is_over() const { return terminated_ != nullptr && (*terminated_)(); }
    /// Whether it searches for a goal that is not the task's.
    [[nodiscard]] bool has_users_goal() const noexcept { return users_goal_ != nullptr; }
    [[nodiscard]] std::uint64_t iterations() const noexcept { return iterations_; }
    [[nodiscard]] const std::optional<Candidate>& best() const noexcept { return best_; }
    /// @pre solve() was called and found a start
    [[nodiscard]] const TreeGrowth& growth() const noexcept { return *growth_; }
    /// Counts everything that was simulated in the planner's own model since the last clear().
    [[nodiscard]] FlightStatistics statistics() const;

 protected:
    /// A solution as the planner hands it to its problem definition.
    [[nodiscard]] virtual ompl::base::PathPtr make_path(const std::vector<FlightPoint>& moments) const;

 private:
    /// A plan on its way to become the best, of the refiner or of the tree.
    struct Proposal {
        Candidate candidate;
        int refined = 0;             ///< number of the refiner's plan, or
        FlightNode* hold = nullptr;  ///< a hold of the tree
        bool is_good = false;        ///< it counts
    };

    [[nodiscard]] bool adopt_goal();
    [[nodiscard]] bool adopt_objective();
    void begin(const FlightPoint& start);
    void grow();
    void refine();
    void go_on_side_by_side(const ompl::base::PlannerTerminationCondition& terminated);
    void hand_to_refiner();
    [[nodiscard]] bool is_used_up() const noexcept { return max_iterations_ && iterations_ >= *max_iterations_; }
    [[nodiscard]] std::optional<Proposal> proposal(double min_gain) const;
    void execute(Proposal& proposal) const;
    void settle(Proposal proposal);
    void learn_from(const Proposal& failed, const std::vector<Counterexample>& counterexamples);
    void settle_best(const ompl::base::PlannerTerminationCondition& terminated);
    [[nodiscard]] static std::size_t steps_back_after(int failures_in_a_row);
    [[nodiscard]] double work_beside(const Candidate& candidate) const;
    ompl::base::PlannerStatus report_solution();

    const SearchTask& task_;
    const SearchSpace& space_;
    FlightTreeParameters parameters_;
    int threads_;
    CandidateHooks hooks_;
    std::function<void()> observer_;
    std::optional<std::uint64_t> max_iterations_;
    bool stops_at_first_plan_ = false;
    std::optional<Plan> known_plan_;
    std::vector<Configuration> known_places_;
    const ompl::base::PlannerTerminationCondition* terminated_ = nullptr;  ///< condition of the solve() under way

    PlannedFlights flights_;                          ///< flights of the tree
    PlannedFlights refined_flights_;                  ///< flights of the refiner
    std::unique_ptr<OmplGoal> users_goal_;            ///< nullptr: the goal is the task's
    std::unique_ptr<OmplObjective> users_objective_;  ///< nullptr: the objective is the task's
    std::unique_ptr<OmplSampler> sampler_;
    Random refiner_random_;
    std::optional<TreeGrowth> growth_;
    std::optional<PlanRefiner> refiner_;
    std::uint64_t iterations_ = 0;
    std::optional<Candidate> best_;
    /// A plan that the refiner takes on in the next round; see PlanRefiner::work_on().
    struct HandedOver {
        Lineage lineage;
        std::size_t steps_back = 0;
    };
    std::vector<HandedOver> handed_over_;
    int failures_in_a_row_ = 0;           ///< failures of plans that were executed
    double handed_over_cost_ = HUGE_VAL;  ///< cost of the tree's plan that the refiner got last
    std::size_t idle_rounds_ = 0;         ///< rounds in a row in which the refiner had no plan
    double tree_left_ = 0;                ///< work in this round; below 0 what was done too much
    double refiner_left_ = 0;             ///< work of the refiner in this round
};

}  // namespace downwash::planning
