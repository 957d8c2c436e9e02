#include "downwash/planner/flight_search.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <optional>
#include <system_error>
#include <utility>

#include "downwash/ompl_planners/control_planners.hpp"
#include "downwash/planner/braking.hpp"
#include "downwash/planner/direct_flight.hpp"
#include "downwash/planner/search_clock.hpp"
#include "downwash/planner/worlds.hpp"
#include "downwash/search/flight_space.hpp"
#include "downwash/search/flight_tree_planner.hpp"
#include "downwash/search/quiet_ompl.hpp"
#include "downwash/search/tree_record.hpp"

namespace downwash::planning {
namespace {

/// Where a direct flight that does not count came nearest to an obstacle or, if that is not why, where it ended.
Obstruction obstruction_of(const Execution& flight, const SearchSpace& space) {
    if (flight.outcome == Outcome::over_budget) {
        return {std::string(name_of(flight.outcome)), configuration_of(flight.rows.back().q), 0};
    }
    const auto nearest =
        std::min_element(flight.rows.begin(), flight.rows.end(),
                         [](const FlightRow& a, const FlightRow& b) { return a.clearance_m < b.clearance_m; });
    const bool is_too_near = flight.outcome == Outcome::ok || flight.outcome == Outcome::collision;
    const double(&q)[4] = (is_too_near ? *nearest : flight.rows.back()).q;
    return {"direct_flight", configuration_of(q), space.goal_distance_m(configuration_of(q))};
}

/// A search whose edges are flights: every better plan of MP-ARM-ADA is executed with direct aerodynamics before it
/// counts, and everything that was simulated is accounted for.
class FlightSearch {
 public:
    FlightSearch(const Problem& part, const Problem& whole, const PlannerModel& model, const Course& before,
                 const PlanChecks& checks, const SolveOptions& options)
        : options_(options),
          before_(before),
          goals_(before.goals),
          clock_(part.planner, options),
          worlds_(checks.worlds),
          stop_finder_(before.goals.size() == whole.goals_before.size() ? checks.stop_finder : nullptr),
          search_worlds_(worlds_ != nullptr ? worlds_->for_search(before) : SearchWorlds{}),
          task_(part, *model.flight, model.map.get(), before.vehicle, worlds_ != nullptr ? &search_worlds_ : nullptr,
                before.ticks()),
          start_(before.plan.reference.empty() ? before.vehicle : start_state(*model.flight, whole.start)) {
        goals_.push_back(part.goal);
        result_.attempts = before.attempts;
    }

    /// RRT* of flights.
    [[nodiscard]] SearchResult run_tree();
    /// OMPL's planners over controls.
    [[nodiscard]] SearchResult run_controls();

 private:
    [[nodiscard]] bool is_over() { return result_.weak_goal || clock_.is_over(); }
    [[nodiscard]] bool has_plan() const { return result_.found.status == Status::solved; }
    [[nodiscard]] bool survives_execution(const Plan& plan, double cost);
    [[nodiscard]] bool flies_well(const Plan& plan);
    [[nodiscard]] bool needs_certificate() const { return worlds_ != nullptr && goals_.size() == worlds_->goals(); }
    [[nodiscard]] WorldCounter world_counter() {
        return [this](std::uint64_t worlds, std::uint64_t failures) { clock_.certifies(worlds, failures); };
    }
    [[nodiscard]] bool is_certified(const Plan& plan, double cost);
    [[nodiscard]] bool can_stop(const Plan& plan);
    [[nodiscard]] std::vector<Counterexample> new_counterexamples();
    void accept(const Plan& plan, double cost, std::uint64_t iteration);
    /// A plan that comes near the goal only.
    struct Approach {
        Status status = Status::none;
        std::optional<Plan> plan;
        double cost = 0;
        std::optional<double> nearest_m;
    };
    [[nodiscard]] SearchResult result(std::uint64_t iterations, const FlightStatistics& statistics,
                                      const Approach& nearest);
    void report_failure(const FlightStatistics& statistics, const Approach& nearest);

    const SolveOptions& options_;
    const Course& before_;
    std::vector<Goal> goals_;  ///< up to the one that is searched for
    SearchResult result_;      ///< with the best plan so far
    SearchClock clock_;
    ProblemWorlds* worlds_;
    StopFinder* stop_finder_;  ///< asked for plans to the last goal
    SearchWorlds search_worlds_;
    SearchTask task_;
    FlightState start_;                            ///< where the whole flight begins
    std::optional<DirectFlight> flight_;           ///< made last
    std::optional<Obstruction> discarded_;         ///< what discarded the last plan that was
    std::optional<Certificate> certificate_;       ///< certificate of the plan that was executed last
    std::optional<SafeStops> stops_;               ///< along that plan
    std::vector<Counterexample> counterexamples_;  ///< in which that plan failed
    std::optional<std::size_t> weakest_;           ///< part of that plan
    /// The plan without a certificate that has the lowest bound of its failure probability: one that was
    /// interrupted after a few worlds says little.
    struct Uncertified {
        Plan plan;
        double cost;
        Certificate certificate;
    };
    std::optional<Uncertified> uncertified_;
    double known_at_s_ = 0;  ///< when it was known whether the last plan counts
};

/// Executes a plan and says whether it counts; that of MP-ARM-ADA has to be good in this flight, too.
bool FlightSearch::survives_execution(const Plan& plan, double cost) {
    counterexamples_.clear();
    clock_.found_first(clock_.seconds());
    if (uncertified_ && is_over()) {
        return false;  // too late for a certificate
    }
    const PlannerSettings& settings = task_.problem.planner;
    if (settings.variant == Variant::mp_arm_ada && !flies_well(plan)) {
        return false;
    }
    known_at_s_ = clock_.seconds();
    return (worlds_ == nullptr || is_certified(plan, cost)) && can_stop(plan);
}

/// Whether a plan of MP-ARM-ADA is good when executed with direct aerodynamics. If the plan needs a certificate,
/// another thread begins with it meanwhile; a plan that is not good has asked for none.
bool FlightSearch::flies_well(const Plan& plan) {
    const Plan flown = before_.plan.followed_by(plan);
    bool is_finished = false;
    std::atomic<bool> is_bad = false;
    const auto fly = [&] {
        try {
            flight_ = fly_directly(task_.model, start_, flown, goals_, task_.problem.energy_budget_j,
                                   [this] { return is_over(); });
            is_finished = true;
        } catch (const WorkStopped&) {  // too late
        }
        is_bad = !is_finished || !is_good(flight_->execution, task_.problem.planner.safety_margin_m);
    };
    const auto certify = [&] {
        if (!is_bad) {
            certificate_ = worlds_->certify(
                flown, result_.attempts + 1, [&] { return is_bad || is_over(); }, world_counter());
            clock_.has_certified();
        }
    };
    // The certificate stays on this thread: where it is solve()'s own, it tells the caller how the search goes.
    std::future<void> flight;
    if (needs_certificate() && options_.threads > 1) {
        try {
            flight = std::async(std::launch::async, fly);
        } catch (const std::system_error&) {  // no more threads
        }
    }
    if (!flight.valid()) {
        fly();
    }
    if (needs_certificate()) {
        certify();
    }
    if (flight.valid()) {
        flight.get();
    }
    if (!is_finished) {
        discarded_ = Obstruction{"unfinished_flight", plan.last(), 0};
    } else if (is_bad) {
        discarded_ = obstruction_of(flight_->execution, task_.space);
    }
    return !is_bad;
}

/// Whether a plan can be left for a hover as long as the one that counts. The first one counts in any case.
bool FlightSearch::can_stop(const Plan& plan) {
    stops_.reset();
    if (stop_finder_ == nullptr) {
        return true;
    }
    try {
        stops_ = stop_finder_->along(before_.plan.followed_by(plan), [this] { return clock_.is_over(); });
    } catch (const WorkStopped&) {  // too late to know, and to find another one
        return !has_plan();
    }
    return !result_.found.safe_stops || !is_clearly_worse(*stops_, *result_.found.safe_stops);
}

/// Whether a plan fails rarely enough in worlds that the search has not seen. One that ends before the last goal needs
/// no certificate; any other has been flown for one.
bool FlightSearch::is_certified(const Plan& plan, double cost) {
    if (needs_certificate()) {
        ++result_.attempts;
    } else {
        certificate_ = worlds_->screen(
            before_.plan.followed_by(plan), goals_.size(), [this] { return is_over(); }, world_counter());
        clock_.has_certified();
    }
    known_at_s_ = clock_.seconds();
    if (certificate_->is_given) {
        return true;
    }
    if (!uncertified_ || certificate_->failure_probability.high < uncertified_->certificate.failure_probability.high) {
        uncertified_ = {plan, cost, *certificate_};
    }
    discarded_ = Obstruction{"certificate", plan.last(), 0};
    counterexamples_ = worlds_->counterexamples(*certificate_, before_);
    weakest_ = weakest_part(*certificate_);
    return false;
}

/// Worlds in which the last plan failed, for the search to learn from between two of its rounds. If an earlier part of
/// the flight is to blame, the search ends, unless it has shown that these parts can be good enough.
std::vector<Counterexample> FlightSearch::new_counterexamples() {
    const std::optional<std::size_t> weakest = std::exchange(weakest_, std::nullopt);
    if (weakest && *weakest < before_.goals.size() && !has_plan()) {
        result_.weak_goal = weakest;
    }
    return std::exchange(counterexamples_, {});
}

/// Takes on the plan that survived last; it has counted since that was known. One that is cheaper in the planner's
/// model only, and not when executed, is no better.
void FlightSearch::accept(const Plan& plan, double cost, std::uint64_t iteration) {
    Found& best = result_.found;
    const CostFunction& objective = task_.problem.planner.objective;
    std::optional<double> executed_cost;
    if (flight_) {
        executed_cost = cost_of(flight_->execution, objective);
        if (best.execution && *executed_cost >= cost_of(*best.execution, objective)) {
            return;
        }
        best.execution = std::move(flight_->execution);
        best.flight_wall_s = flight_->wall_s;
        flight_.reset();
    }
    best.status = Status::solved;
    best.plan = plan;
    best.cost = cost;
    best.certificate = certificate_;
    best.safe_stops = stops_;
    if (certificate_ && !clock_.record.first_certified_wall_s) {
        clock_.record.first_certified_wall_s = known_at_s_;
    }
    clock_.improved(known_at_s_, cost, iteration, executed_cost);
    if (options_.on_plan) {
        options_.on_plan({plan, cost, executed_cost});
    }
}

/// What the search came to. @param nearest in place of a plan, if there is none
SearchResult FlightSearch::result(std::uint64_t iterations, const FlightStatistics& statistics,
                                  const Approach& nearest) {
    SearchRecord& record = clock_.record;
    record.wall_s = clock_.seconds();
    record.iterations = iterations;
    record.edges_simulated = statistics.edges;
    record.simulated_s = static_cast<double>(statistics.ticks) * task_.model.tick().tick_s;
    record.states_checked = statistics.states_checked;
    record.rejected = statistics.rejected;
    result_.record = std::move(record);
    if (!has_plan()) {
        report_failure(statistics, nearest);
    }
    if (result_.found.certificate) {
        result_.found.certificate->attempts = result_.attempts;
    }
    return std::move(result_);
}

/// Reports what a search without a plan that counts came to, and what stood before the goal. If it had a plan, that is
/// what became of its execution.
void FlightSearch::report_failure(const FlightStatistics& statistics, const Approach& nearest) {
    Found& found = result_.found;
    found.obstruction = discarded_ ? discarded_ : statistics.obstruction;
    found.nearest_approach_m = nearest.nearest_m;
    found.status = nearest.status;
    found.plan = nearest.plan;
    found.cost = nearest.cost;
    if (uncertified_) {
        found.status = Status::approximate;
        found.plan = uncertified_->plan;
        found.cost = uncertified_->cost;
        found.certificate = uncertified_->certificate;
    }
}

SearchResult FlightSearch::run_controls() {
    const PlannerSettings& settings = task_.problem.planner;
    Random random(settings.seed);
    PlannedFlights planned(
        task_, [this] { return is_over(); }, options_.threads);
    const SteeredFlights flights(planned);
    ControlHooks hooks;
    hooks.keep_tree = options_.keep_tree;
    hooks.is_over = [&](std::uint64_t iteration) {
        clock_.note(iteration, planned.statistics().edges, planned.statistics().rejections);
        return is_over() || (settings.max_iterations && iteration >= *settings.max_iterations);
    };
    hooks.accept = [&](const Plan& plan, double cost, std::uint64_t iteration) {
        if (!survives_execution(plan, cost)) {
            return false;
        }
        accept(plan, cost, iteration);
        return true;
    };
    ControlResult result = plan_by_controls(flights, random, hooks);
    result_.found.tree = std::move(result.tree);
    return this->result(result.iterations, planned.statistics(),
                        {result.status, std::move(result.plan), result.cost, result.nearest_approach_m});
}

SearchResult FlightSearch::run_tree() {
    const QuietOmpl quiet;
    const PlannerSettings& settings = task_.problem.planner;
    const double tick_s = task_.model.tick().tick_s;
    Random random(settings.seed);  // of OMPL's samplers, which the tree does not ask
    const OmplTask task(task_, random);
    FlightTreePlanner planner(task.information, task_, options_.threads);
    planner.setProblemDefinition(task.definition);
    planner.set_hooks({[&](const Candidate& candidate) {
                           return survives_execution(plan_through(candidate.moments, tick_s), candidate.cost);
                       },
                       [&] { return new_counterexamples(); },
                       [&](const Candidate& candidate) {
                           accept(plan_through(candidate.moments, tick_s), candidate.cost, candidate.iteration);
                       }});
    planner.set_max_iterations(settings.max_iterations);
    planner.set_stops_at_first_plan(options_.stop_at_first_solution);
    planner.set_known(options_.known_plan, options_.known_places);
    planner.set_observer(
        [&] { clock_.note(planner.iterations(), planner.growth().tree().size(), planner.statistics().rejections); });
    planner.setup();
    planner.solve(ompl::base::PlannerTerminationCondition([this] { return is_over(); }));

    if (options_.keep_tree) {
        result_.found.tree = tree_of(
            planner, [](const ompl::base::State* state) { return configuration_of(point_of(state).reference); });
    }
    const FlightNode& nearest = planner.growth().nearest_to_goal();
    Approach approach;
    approach.nearest_m = planner.growth().nearest_distance_m();
    if (nearest.parent != nullptr) {
        approach.status = Status::approximate;
        approach.plan = planner.growth().tree().plan_to(nearest);
        approach.cost = nearest.cost;
    }
    return result(planner.iterations(), planner.statistics(), approach);
}

}  // namespace

SearchResult search_flights(const Problem& part, const Problem& whole, const PlannerModel& model, const Course& before,
                            const PlanChecks& checks, const SolveOptions& options) {
    FlightSearch search(part, whole, model, before, checks, options);
    return part.planner.algorithm == "rrt-star" ? search.run_tree() : search.run_controls();
}

}  // namespace downwash::planning
