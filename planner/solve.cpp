#include "downwash/planner/solve.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <utility>

#include "downwash/planner/goal_sequence.hpp"
#include "downwash/rivals/control_planners.hpp"
#include "downwash/rivals/mp_arm.hpp"
#include "downwash/search/flight_tree_planner.hpp"
#include "downwash/search/ompl_space.hpp"
#include "downwash/search/quiet_ompl.hpp"
#include "downwash/search/search_tree.hpp"

namespace downwash {
namespace {

class Stopwatch {
 public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }

 private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// What every search has in common: its limits, its clock and whom it tells.
class Search {
 public:
    Search(const Problem& problem, const SolveOptions& options, Solution& solution)
        : settings_(problem.planner), options_(options), solution_(solution) {
        if (settings_.time_limit_s || !settings_.max_iterations) {
            limit_s_ = settings_.time_limit_s.value_or(default_time_limit_s);
        }
    }

    [[nodiscard]] double seconds() const { return clock_.seconds(); }

    [[nodiscard]] bool is_over() const {
        return options_.stop.stop_requested() || (limit_s_ && clock_.seconds() >= *limit_s_) ||
               (options_.stop_at_first_solution && !solution_.planning.improvements.empty());
    }

    void found_first(double at_s) {
        if (!solution_.planning.first_solution_wall_s) {
            solution_.planning.first_solution_wall_s = at_s;
        }
    }

    void improved(double at_s, double cost, std::uint64_t iteration, std::optional<double> flown_cost) {
        solution_.planning.improvements.push_back({at_s, iteration, cost, flown_cost});
    }

    void report(std::uint64_t iterations, std::uint64_t nodes, std::uint64_t rejected) {
        constexpr double period_s = 0.1;
        const double now_s = clock_.seconds();
        if (!options_.on_progress || now_s < reported_s_ + period_s) {
            return;
        }
        reported_s_ = now_s;
        const auto& improvements = solution_.planning.improvements;
        options_.on_progress({now_s, iterations, nodes, rejected,
                              improvements.empty() ? std::nullopt : std::optional(improvements.back().cost)});
    }

 private:
    const PlannerSettings& settings_;
    const SolveOptions& options_;
    Solution& solution_;
    Stopwatch clock_;
    std::optional<double> limit_s_;
    double reported_s_ = 0;
};

/// Flies a plan with direct aerodynamics and says how long that took.
Execution fly_directly(const FlightState& start, std::span<const Goal> goals, const FlightModel& model,
                       const Plan& plan, double& wall_s) {
    const Stopwatch clock;
    Execution execution = execute(model, start, plan.reference, goals, true);
    wall_s = clock.seconds();
    return execution;
}

/// Where a direct flight that does not count came nearest to an obstacle or, if that is not why, where it ended.
Obstruction obstruction_of(const Execution& flight, const planning::SearchSpace& space) {
    const auto nearest =
        std::min_element(flight.rows.begin(), flight.rows.end(),
                         [](const FlightRow& a, const FlightRow& b) { return a.clearance_m < b.clearance_m; });
    const bool is_too_near = flight.outcome == Outcome::ok || flight.outcome == Outcome::collision;
    const double* q = (is_too_near ? *nearest : flight.rows.back()).q;
    return {"direct_flight", {q[0], q[1], q[3]}, space.goal_distance_m({q[0], q[1], q[3]})};
}

void search_geometrically(const Problem& problem, const FlightModel& model, const SolveOptions& options,
                          Solution& solution) {
    const planning::SearchSpace space(problem, model);
    planning::Random random(problem.planner.seed);
    Search search(problem, options, solution);
    planning::GeometricHooks hooks;
    hooks.keep_tree = options.keep_tree;
    hooks.is_over = [&](const planning::GeometricProgress& progress) {
        search.report(progress.iteration, progress.nodes, progress.refused);
        return search.is_over() ||
               (problem.planner.max_iterations && progress.iteration >= *problem.planner.max_iterations);
    };
    hooks.on_improvement = [&](double cost, std::uint64_t iteration) {
        const double now_s = search.seconds();
        search.found_first(now_s);
        search.improved(now_s, cost, iteration, {});
    };
    planning::GeometricResult result = planning::plan_geometrically(problem, model, space, random, hooks);
    solution.tree = std::move(result.tree);
    SearchRecord& record = solution.planning;
    record.wall_s = search.seconds();
    record.iterations = result.iterations;
    record.states_checked = result.states_checked;
    record.rejected = planning::no_rejections();
    record.rejected["collision"] = result.refused_collision;
    record.rejected["bounds"] = result.refused_bounds;
    if (result.status != Status::solved) {
        record.nearest_approach_m = result.nearest_approach_m;
    }
    if (result.plan && result.plan->reference.back().tick > max_plan_ticks) {
        record.rejected["too_long"] = 1;
        record.improvements.clear();
        record.first_solution_wall_s.reset();
        return;
    }
    solution.status = result.status;
    solution.plan = std::move(result.plan);
    solution.cost = result.cost;
}

/// What searches whose edges are flights have in common: every better plan of mp-arm-ada is flown with direct
/// aerodynamics before it counts, and everything flown is accounted for.
struct FlightSearch {
    /// @param whole the problem of which this one is a part, if not all   @param course that lies before it
    FlightSearch(const Problem& of, const Problem& whole, const FlightModel& with, const SolveOptions& how,
                 const AeroMap* map, const planning::Course& course, Solution& into)
        : problem(of),
          start(start_state(with, whole.start)),
          before(course),
          goals(course.goals),
          model(with),
          solution(into),
          options(how),
          search(of, how, into),
          space(of, with),
          random(of.planner.seed),
          flights(
              of, with, space, map, [this] { return search.is_over(); }, how.threads, course.vehicle) {
        goals.push_back(of.goal);
    }

    /// Whether a plan counts; one of mp-arm-ada has to fly directly, and to keep the margin in doing so.
    bool counts(const Plan& plan) {
        search.found_first(search.seconds());
        if (problem.planner.variant == Variant::mp_arm_ada) {
            flown = fly_directly(start, goals, model, before.continued_by(plan), flown_wall_s);
        }
        known_at_s = search.seconds();
        if (!flown || (flown->outcome == Outcome::ok && flown->min_clearance_m >= problem.planner.safety_margin_m)) {
            return true;
        }
        discarded = obstruction_of(*flown, space);
        return false;
    }

    /// Takes on the plan of which counts() was asked last; it has counted since the answer was known. One that is
    /// cheaper in the planner's model only, and not when flown, is no better.
    void accept(const Plan& plan, double cost, std::uint64_t iteration) {
        std::optional<double> flown_cost;
        if (flown) {
            flown_cost = cost_of(*flown, problem.planner.objective);
            if (solution.execution && *flown_cost >= cost_of(*solution.execution, problem.planner.objective)) {
                return;
            }
            solution.execution = std::move(*std::exchange(flown, std::nullopt));
            solution.planning.flight_wall_s = flown_wall_s;
        }
        solution.status = Status::solved;
        solution.plan = plan;
        solution.cost = cost;
        search.improved(known_at_s, cost, iteration, flown_cost);
    }

    /// What stood before the goal of a search that found no plan: if it had one, what became of its flight.
    void tell_obstruction(const planning::FlightStatistics& statistics) {
        solution.planning.obstruction = discarded ? discarded : statistics.obstruction;
    }

    void account(std::uint64_t iterations, const planning::FlightStatistics& statistics) {
        SearchRecord& record = solution.planning;
        record.wall_s = search.seconds();
        record.iterations = iterations;
        record.edges_simulated = statistics.edges;
        record.simulated_s = static_cast<double>(statistics.ticks) * model.tick().tick_s;
        record.states_checked = statistics.states_checked;
        record.rejected = statistics.rejected;
    }

    const Problem& problem;
    FlightState start;  ///< of the whole flight
    const planning::Course& before;
    std::vector<Goal> goals;  ///< up to the one that is searched for
    const FlightModel& model;
    Solution& solution;
    const SolveOptions& options;
    Search search;
    planning::SearchSpace space;
    planning::Random random;
    planning::PlannedFlights flights;
    std::optional<Execution> flown;  ///< the direct flight made last
    double flown_wall_s = 0;
    std::optional<Obstruction> discarded;  ///< what refused the plan that was discarded last
    double known_at_s = 0;                 ///< when it was known whether the plan counts
};

/// OMPL's planners over controls.
void search_by_controls(FlightSearch& common) {
    const PlannerSettings& settings = common.problem.planner;
    planning::SteeredFlights flights(common.problem, common.space, common.flights);
    planning::ControlHooks hooks;
    hooks.keep_tree = common.options.keep_tree;
    hooks.is_over = [&](std::uint64_t iteration) {
        const planning::FlightStatistics& flown = common.flights.statistics();
        common.search.report(iteration, flown.edges, flown.rejections);
        return common.search.is_over() || (settings.max_iterations && iteration >= *settings.max_iterations);
    };
    hooks.accept = [&](const Plan& plan, double cost, std::uint64_t iteration) {
        if (!common.counts(plan)) {
            return false;
        }
        common.accept(plan, cost, iteration);
        return true;
    };
    planning::ControlResult result =
        planning::plan_by_controls(settings.algorithm, settings.seed, flights, common.random, hooks);
    common.account(result.iterations, common.flights.statistics());
    Solution& solution = common.solution;
    solution.tree = std::move(result.tree);
    if (solution.status == Status::solved) {
        return;
    }
    common.tell_obstruction(common.flights.statistics());
    solution.planning.nearest_approach_m = result.nearest_approach_m;
    solution.status = result.status;
    solution.plan = std::move(result.plan);
    solution.cost = result.cost;
}

/// The tree of flights.
void search_by_flights(FlightSearch& common) {
    planning::FlightTree tree(common.problem, common.model, common.space, common.flights);
    planning::QueryCounts counts;
    const planning::QuietOmpl quiet;
    const auto information = planning::make_space_information(common.space, common.random, 0.1, counts);
    planning::CandidateHooks hooks;
    hooks.counts = [&](const planning::Candidate& candidate) { return common.counts(candidate.plan); };
    hooks.accept = [&](const planning::Candidate& candidate) {
        common.accept(candidate.plan, candidate.cost, candidate.iteration);
    };
    planning::FlightTreePlanner planner(information, common.problem, tree, common.space, common.flights, common.random,
                                        hooks, common.options.threads);
    planner.set_max_iterations(common.problem.planner.max_iterations);
    planner.set_stops_at_first_plan(common.options.stop_at_first_solution);
    planner.set_observer(
        [&] { common.search.report(planner.iterations(), tree.size(), planner.statistics().rejections); });
    planner.solve(ompl::base::PlannerTerminationCondition([&] { return common.search.is_over(); }));

    const planning::FlightStatistics statistics = planner.statistics();
    common.account(planner.iterations(), statistics);
    Solution& solution = common.solution;
    if (common.options.keep_tree) {
        solution.tree = planning::tree_of(
            planner, [&common](const ompl::base::State* state) { return planning::read(state, common.space); });
    }
    if (solution.status == Status::solved) {
        return;
    }
    common.tell_obstruction(statistics);
    solution.planning.nearest_approach_m = planner.nearest_distance_m();
    if (planner.nearest_to_goal().parent != nullptr) {
        solution.status = Status::approximate;
        solution.plan = tree.plan_to(planner.nearest_to_goal());
        solution.cost = planner.nearest_to_goal().cost;
    }
}

}  // namespace

Solution solve(const Problem& problem, const SolveOptions& asked) {
    const Stopwatch since_call;
    SolveOptions options = asked;
    options.threads = std::max(1, options.threads);
    if (std::vector<KeyError> errors = problem_errors(problem); !errors.empty()) {
        throw InputError(std::move(errors));
    }
    const auto model = make_flight_model(problem);
    Solution solution;
    solution.variant = problem.planner.variant;
    solution.algorithm = problem.planner.algorithm;
    solution.objective = problem.planner.objective;
    solution.seed = problem.planner.seed;
    solution.threads = options.threads;

    std::shared_ptr<const AeroMap> map;
    if (problem.planner.variant == Variant::mp_arm_ada && problem.aero.enabled) {
        const Stopwatch clock;
        map = options.map
                  ? options.map
                  : model->make_map(problem.bounds, options.threads, options.on_map_progress, options.map_cache);
        solution.planning.map_wall_s = clock.seconds();
        solution.map = map;
    }
    const auto search = [&](const Problem& part, const SolveOptions& how, const planning::Course& before,
                            Solution& into) {
        if (problem.planner.variant == Variant::mp_arm) {
            search_geometrically(part, *model, how, into);
            return;
        }
        FlightSearch common(part, problem, *model, how, map.get(), before, into);
        problem.planner.algorithm == "rrt-star" ? search_by_flights(common) : search_by_controls(common);
    };
    solution.planning.setup_wall_s = since_call.seconds();
    if (problem.stops.empty()) {
        search(problem, options, planning::Course::from_start(problem, *model), solution);
    } else {
        planning::solve_in_turn(problem, *model, map.get(), options, search, solution);
    }
    if (solution.plan && !(solution.execution && solution.status == Status::solved)) {
        solution.execution = fly_directly(start_state(*model, problem.start), goals_of(problem), *model, *solution.plan,
                                          solution.planning.flight_wall_s);
    }
    solution.interrupted = options.stop.stop_requested();
    if (solution.execution) {
        solution.execution_cost = cost_of(*solution.execution, solution.objective);
    }
    return solution;
}

}  // namespace downwash
