#include "downwash/planner/flight_search.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <optional>
#include <system_error>
#include <utility>

#include "downwash/planner/search_clock.hpp"
#include "downwash/rivals/control_planners.hpp"
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
    FlightSearch(const Problem& part, const Problem& whole, const FlightModel& model, const AeroMap* map,
                 const Course& before, const PlanChecks& checks, const SolveOptions& options, Solution& solution)
        : options_(options),
          before_(before),
          goals_(before.goals),
          solution_(solution),
          clock_(part, options, solution),
          worlds_(checks.worlds),
          stop_finder_(before.goals.size() == whole.stops.size() ? checks.stops : nullptr),
          search_worlds_(worlds_ != nullptr ? worlds_->for_search(before) : SearchWorlds{}),
          task_(part, model, map, before.vehicle, worlds_ != nullptr ? &search_worlds_ : nullptr,
                before.plan.reference.empty() ? 0 : before.plan.reference.back().tick),
          start_(before.plan.reference.empty() ? before.vehicle : start_state(model, whole.start)),
          attempts_(before.attempts) {
        goals_.push_back(part.goal);
    }

    /// RRT* of flights.
    void run_tree();
    /// OMPL's planners over controls.
    void run_controls();
    /// See PartSearch.
    [[nodiscard]] std::optional<std::size_t> weak_goal() const { return weak_goal_; }

 private:
    [[nodiscard]] bool is_over() { return weak_goal_ || clock_.is_over(); }
    [[nodiscard]] bool survives_execution(const Plan& plan, double cost);
    [[nodiscard]] bool flies_well(const Plan& plan);
    [[nodiscard]] bool needs_certificate() const { return worlds_ != nullptr && goals_.size() == worlds_->goals(); }
    [[nodiscard]] WorldCounter world_counter() {
        return [this](std::uint64_t worlds, std::uint64_t failures) { clock_.certifies(worlds, failures); };
    }
    [[nodiscard]] bool is_certified(const Plan& plan, double cost);
    [[nodiscard]] bool can_stop(const Plan& plan);
    [[nodiscard]] std::vector<Counterexample> lessons();
    void accept(const Plan& plan, double cost, std::uint64_t iteration);
    void account(std::uint64_t iterations, const FlightStatistics& statistics);
    void report_failure(const FlightStatistics& statistics, Status status, std::optional<Plan> plan, double cost,
                        std::optional<double> nearest_approach_m);

    const SolveOptions& options_;
    const Course& before_;
    std::vector<Goal> goals_;  ///< up to the one that is searched for
    Solution& solution_;
    SearchClock clock_;
    ProblemWorlds* worlds_;
    StopFinder* stop_finder_;  ///< of plans to the last goal
    SearchWorlds search_worlds_;
    SearchTask task_;
    FlightState start_;                   ///< of the whole flight
    std::optional<Execution> execution_;  ///< made last
    double execution_wall_s_ = 0;
    std::optional<Obstruction> discarded_;         ///< what discarded the last plan that was
    std::uint64_t attempts_;                       ///< plans that asked for a certificate
    std::optional<Certificate> certificate_;       ///< of the plan that was executed last
    std::optional<SafeStops> stops_;               ///< along that plan
    std::vector<Counterexample> counterexamples_;  ///< in which that plan failed
    std::optional<std::size_t> weakest_;           ///< part of that plan
    std::optional<std::size_t> weak_goal_;         ///< see PartSearch
    /// Of the plans without a certificate the one with the lowest bound of its failure probability: one that was
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
    const Plan flown = before_.continued_by(plan);
    bool is_finished = false;
    std::atomic<bool> is_bad = false;
    const auto fly = [&] {
        try {
            execution_ = execute_directly(task_.model, start_, flown, goals_, task_.problem.energy_budget_j,
                                          execution_wall_s_, [this] { return is_over(); });
            is_finished = true;
        } catch (const WorkStopped&) {  // too late
        }
        is_bad = !is_finished || !is_good(*execution_, task_.problem.planner.safety_margin_m);
    };
    const auto certify = [&] {
        if (!is_bad) {
            certificate_ = worlds_->certify(
                flown, attempts_ + 1, [&] { return is_bad || is_over(); }, world_counter());
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
        discarded_ = obstruction_of(*execution_, task_.space);
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
        stops_ = stop_finder_->along(before_.continued_by(plan), [this] { return clock_.is_over(); });
    } catch (const WorkStopped&) {  // too late to know, and to find another one
        return solution_.status != Status::solved;
    }
    return !solution_.stops || !stops_less(*stops_, *solution_.stops);
}

/// Whether a plan fails rarely enough in worlds that the search has not seen. One that ends before the last goal needs
/// no certificate; any other has been flown for one.
bool FlightSearch::is_certified(const Plan& plan, double cost) {
    if (needs_certificate()) {
        ++attempts_;
    } else {
        certificate_ = worlds_->screen(
            before_.continued_by(plan), goals_.size(), [this] { return is_over(); }, world_counter());
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

/// What the search may learn from a plan that did not survive, between two of its rounds. That it was the fault of an
/// earlier part ends the search, unless it has shown that these parts can be good enough.
std::vector<Counterexample> FlightSearch::lessons() {
    const std::optional<std::size_t> weakest = std::exchange(weakest_, std::nullopt);
    if (weakest && *weakest < before_.goals.size() && solution_.status != Status::solved) {
        weak_goal_ = weakest;
    }
    return std::exchange(counterexamples_, {});
}

/// Takes on the plan that survived last; it has counted since that was known. One that is cheaper in the planner's
/// model only, and not when executed, is no better.
void FlightSearch::accept(const Plan& plan, double cost, std::uint64_t iteration) {
    const CostFunction& objective = task_.problem.planner.objective;
    std::optional<double> executed_cost;
    if (execution_) {
        executed_cost = cost_of(*execution_, objective);
        if (solution_.execution && *executed_cost >= cost_of(*solution_.execution, objective)) {
            return;
        }
        solution_.execution = std::move(*std::exchange(execution_, std::nullopt));
        solution_.planning.flight_wall_s = execution_wall_s_;
    }
    solution_.status = Status::solved;
    solution_.plan = plan;
    solution_.cost = cost;
    solution_.certificate = certificate_;
    solution_.stops = stops_;
    if (certificate_ && !solution_.planning.first_certified_wall_s) {
        solution_.planning.first_certified_wall_s = known_at_s_;
    }
    clock_.improved(known_at_s_, cost, iteration, executed_cost);
    if (options_.on_plan) {
        options_.on_plan({plan, cost, executed_cost});
    }
}

void FlightSearch::account(std::uint64_t iterations, const FlightStatistics& statistics) {
    SearchRecord& record = solution_.planning;
    record.wall_s = clock_.seconds();
    record.iterations = iterations;
    record.edges_simulated = statistics.edges;
    record.simulated_s = static_cast<double>(statistics.ticks) * task_.model.tick().tick_s;
    record.states_checked = statistics.states_checked;
    record.rejected = statistics.rejected;
    if (solution_.certificate) {
        solution_.certificate->attempts = attempts_;
    }
}

/// Of a search that found no plan that counts: what it came to, and what stood before the goal. If it had a plan, that
/// is what became of its execution.
void FlightSearch::report_failure(const FlightStatistics& statistics, Status status, std::optional<Plan> plan,
                                  double cost, std::optional<double> nearest_approach_m) {
    solution_.planning.obstruction = discarded_ ? discarded_ : statistics.obstruction;
    solution_.planning.nearest_approach_m = nearest_approach_m;
    solution_.status = status;
    solution_.plan = std::move(plan);
    solution_.cost = cost;
    if (uncertified_) {
        solution_.status = Status::approximate;
        solution_.plan = uncertified_->plan;
        solution_.cost = uncertified_->cost;
        solution_.certificate = uncertified_->certificate;
        solution_.certificate->attempts = attempts_;
    }
}

void FlightSearch::run_controls() {
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
    account(result.iterations, planned.statistics());
    solution_.tree = std::move(result.tree);
    if (solution_.status != Status::solved) {
        report_failure(planned.statistics(), result.status, std::move(result.plan), result.cost,
                       result.nearest_approach_m);
    }
}

void FlightSearch::run_tree() {
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
                       [&] { return lessons(); },
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

    const FlightStatistics statistics = planner.statistics();
    account(planner.iterations(), statistics);
    if (options_.keep_tree) {
        solution_.tree = tree_of(
            planner, [](const ompl::base::State* state) { return configuration_of(point_of(state).reference); });
    }
    if (solution_.status != Status::solved) {
        const FlightNode& nearest = planner.growth().nearest_to_goal();
        const bool has_moved = nearest.parent != nullptr;
        report_failure(statistics, has_moved ? Status::approximate : Status::none,
                       has_moved ? std::optional(planner.growth().tree().plan_to(nearest)) : std::nullopt,
                       has_moved ? nearest.cost : 0, planner.growth().nearest_distance_m());
    }
}

}  // namespace

Execution execute_directly(const FlightModel& model, const FlightState& start, const Plan& plan,
                           const std::vector<Goal>& goals, std::optional<double> energy_budget_j, double& wall_s,
                           const StopCondition& is_over) {
    const Stopwatch clock;
    Execution execution = execute(model, start, plan.reference, goals, true, {}, is_over, energy_budget_j);
    wall_s = clock.seconds();
    return execution;
}

bool is_good(const Execution& flight, double safety_margin_m) {
    return flight.outcome == Outcome::ok && flight.min_clearance_m >= safety_margin_m;
}

std::optional<std::size_t> search_flights(const Problem& part, const Problem& whole, const FlightModel& model,
                                          const AeroMap* map, const Course& before, const PlanChecks& checks,
                                          const SolveOptions& options, Solution& solution) {
    FlightSearch search(part, whole, model, map, before, checks, options, solution);
    part.planner.algorithm == "rrt-star" ? search.run_tree() : search.run_controls();
    return search.weak_goal();
}

}  // namespace downwash::planning
