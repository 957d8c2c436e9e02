#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "downwash/base/stop_condition.hpp"
#include "downwash/search/flight_tree_parameters.hpp"
#include "downwash/search/plan_refiner.hpp"
#include "downwash/search/random.hpp"
#include "downwash/search/tree_growth.hpp"

namespace downwash::planning {

/// A plan that the planner's own model accepts, with the hover at the goal.
template <class Family>
struct CandidateOf {
    using FlightPoint = FlightPointOf<Family>;

    std::vector<FlightPoint> moments;  ///< moments at the plan's knots, then after the hover
    double cost = 0;
    std::uint64_t iteration = 0;
};
using Candidate = CandidateOf<Plane>;

/// What a search asks about its plans. Without functions every plan counts.
template <class Family>
struct CandidateHooksOf {
    using Counterexample = CounterexampleOf<Family>;
    using Candidate = CandidateOf<Family>;

    /// Executes a plan, if need be, and says whether it counts; false discards it and the search goes on. Called with
    /// one plan at a time, but on any thread and beside the search: it may touch nothing that the search works on.
    std::function<bool(const Candidate&)> survives_execution = {};
    /// The worlds in which the last plan failed that did not survive, if the search may learn from them.
    std::function<std::vector<Counterexample>()> counterexamples = {};
    /// Told of every plan that counts, when the search takes it on; each is cheaper than the one before.
    std::function<void(const Candidate&)> accept = {};
};
using CandidateHooks = CandidateHooksOf<Plane>;

/// RRT* whose edges are lines or closed-loop flights, as the variant has them (edge_flights.hpp): parents are chosen
/// and nodes rewired by the cost of what was flown. Samples come in batches, whose edges are flown side by side. What
/// the tree finds is refined to plans that do not stop at their corners. Once there is a plan the search goes on in
/// rounds, in which the tree grows, plans are refined and the best one is executed, side by side; what each of them has
/// found the others see after the round. A round ends by the work done in it, so threads change nothing but the time.
/// Anytime: the best plan only gets cheaper. The convergence theorem of RRT* assumes exact steering and is not claimed
/// here.
template <class Family>
class FlightTreeSearchOf {
 public:
    using Configuration = typename Family::Configuration;
    using Plan = typename Family::Plan;
    using SearchSpace = typename Family::SearchSpace;
    using Counterexample = CounterexampleOf<Family>;
    using SearchTask = SearchTaskOf<Family>;
    using FlightPoint = FlightPointOf<Family>;
    using GoalRegion = GoalRegionOf<Family>;
    using SearchObjective = SearchObjectiveOf<Family>;
    using PlannedFlights = PlannedFlightsOf<Family>;
    using FlightNode = FlightNodeOf<Family>;
    using FlightTree = FlightTreeOf<Family>;
    using PlaceSampler = PlaceSamplerOf<Family>;
    using FlownPlan = FlownPlanOf<Family>;
    using PlanRefiner = PlanRefinerOf<Family>;
    using Lineage = LineageOf<Family>;
    using TreeGrowth = TreeGrowthOf<Family>;
    using FlightStatistics = FlightStatisticsOf<Family>;
    using Candidate = CandidateOf<Family>;
    using CandidateHooks = CandidateHooksOf<Family>;

    /// @param task gives seed and parameters too; must outlive the search
    /// @param threads that the search may use, at least 1; the result does not depend on it
    explicit FlightTreeSearchOf(const SearchTask& task, int threads = 1);

    /// Forgets everything but its settings.
    void clear();

    void set_hooks(CandidateHooks hooks) { hooks_ = std::move(hooks); }
    /// The search ends after so many iterations since the last clear(), whatever the termination condition says.
    void set_max_iterations(std::optional<std::uint64_t> iterations) { max_iterations_ = iterations; }
    /// The search ends with the first plan that counts.
    void set_stops_at_first_plan(bool stops) { stops_at_first_plan_ = stops; }
    /// The search ends with a plan that costs no more and counts; the first one is executed at once.
    void set_enough_cost(std::optional<double> cost) { enough_cost_ = cost; }
    /// What is known before the next search that begins: see SolveOptions.
    void set_known(std::optional<Plan> plan, std::vector<Configuration> places, std::vector<Configuration> way) {
        known_plan_ = std::move(plan);
        known_places_ = std::move(places);
        known_way_ = std::move(way);
    }
    /// Called after every batch, or round, before its plans are executed.
    void set_observer(std::function<void()> observer) { observer_ = std::move(observer); }
    /// Before it begins: what flights lead to and are paid by; see PlannedFlights.
    void lead_to(const GoalRegion* goal) noexcept {
        flights_.lead_to(goal);
        refined_flights_.lead_to(goal);
    }
    void pay_by(const SearchObjective* objective) noexcept {
        flights_.pay_by(objective);
        refined_flights_.pay_by(objective);
    }
    [[nodiscard]] FlightTreeParameters& parameters() noexcept { return parameters_; }
    [[nodiscard]] const FlightTreeParameters& parameters() const noexcept { return parameters_; }

    /// Begins a search. @param random gets the seed of the task; it and the sampler must outlive the search
    void begin(const FlightPoint& start, Random& random, PlaceSampler& sampler);
    [[nodiscard]] bool has_begun() const noexcept { return growth_.has_value(); }
    /// Goes on until one of the conditions holds. @param is_enough whether a plan of this cost is; empty: none is
    /// @pre has_begun()
    void go_on(const StopCondition& terminated, const std::function<bool(double cost)>& is_enough = {});

    /// Whether the condition of the search under way says that it has to end.
    [[nodiscard]] bool is_over() const { return terminated_ != nullptr && (*terminated_)(); }
    [[nodiscard]] std::uint64_t iterations() const noexcept { return iterations_; }
    [[nodiscard]] const std::optional<Candidate>& best() const noexcept { return best_; }
    /// @pre has_begun()
    [[nodiscard]] const TreeGrowth& growth() const noexcept { return *growth_; }
    /// Counts everything that was simulated in the planner's own model since the last clear().
    [[nodiscard]] FlightStatistics statistics() const;

 private:
    /// A plan on its way to become the best, of the refiner or of the tree.
    struct Proposal {
        Candidate candidate;
        int refined = 0;             ///< number of the refiner's plan, or
        FlightNode* hold = nullptr;  ///< a hold of the tree
        bool is_good = false;        ///< it counts
    };

    void grow();
    void refine();
    void go_on_side_by_side(const StopCondition& terminated);
    void hand_to_refiner();
    [[nodiscard]] bool is_used_up() const noexcept { return max_iterations_ && iterations_ >= *max_iterations_; }
    [[nodiscard]] std::optional<Proposal> proposal(double min_gain) const;
    void execute(Proposal& proposal) const;
    void settle(Proposal proposal);
    void learn_from(const Proposal& failed, const std::vector<Counterexample>& counterexamples);
    void settle_best(const StopCondition& terminated);
    [[nodiscard]] static std::size_t steps_back_after(int failures_in_a_row);
    [[nodiscard]] bool suffices(double cost) const noexcept {
        return stops_at_first_plan_ || (enough_cost_ && cost <= *enough_cost_);
    }
    [[nodiscard]] double work_beside(const Candidate& candidate) const;

    const SearchTask& task_;
    const SearchSpace& space_;
    FlightTreeParameters parameters_;
    int threads_;
    CandidateHooks hooks_;
    std::function<void()> observer_;
    std::optional<std::uint64_t> max_iterations_;
    bool stops_at_first_plan_ = false;
    std::optional<double> enough_cost_;
    std::optional<Plan> known_plan_;
    std::vector<Configuration> known_places_, known_way_;
    const StopCondition* terminated_ = nullptr;  ///< condition of the search under way

    PlannedFlights flights_;          ///< flights of the tree
    PlannedFlights refined_flights_;  ///< flights of the refiner
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
using FlightTreeSearch = FlightTreeSearchOf<Plane>;

}  // namespace downwash::planning
