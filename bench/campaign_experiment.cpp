#include "downwash/bench/campaign_experiment.hpp"

#include <algorithm>
#include <chrono>
#include <new>
#include <optional>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/bench/plan_evaluation.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/results/space_solution_file.hpp"

namespace downwash::bench {
namespace {

static_assert(static_cast<int>(RunStatus::none) == static_cast<int>(Status::none));
static_assert(static_cast<int>(RunStatus::approximate) == static_cast<int>(Status::approximate));
static_assert(static_cast<int>(RunStatus::solved) == static_cast<int>(Status::solved));

void fill(Run& run, const SearchRecord& record) {
    if (record.first_solution_wall_s) {
        run.first_solution_s = record.setup_wall_s + *record.first_solution_wall_s;
    }
    run.iterations = record.iterations;
    run.edges_simulated = record.edges_simulated;
    run.states_checked = record.states_checked;
    run.simulated_s = record.simulated_s;
    run.improvements = record.improvements;
    for (Improvement& improvement : run.improvements) {
        improvement.wall_s += record.setup_wall_s;
    }
    run.rejections = record.rejected;
    if (const auto discarded = record.rejected.find("direct_flight"); discarded != record.rejected.end()) {
        run.discarded = discarded->second;
    }
    if (record.first_certified_wall_s) {
        run.first_certified_s = record.setup_wall_s + *record.first_certified_wall_s;
    }
}

double goal_error_of(const Execution& flight) {
    return flight.goal_error_m;
}
double goal_error_of(const SpaceFlight& flight) {
    return worst_goal_error_m(flight);
}

/// @param solution a Solution or a SpaceSearchResult   @param objective by which flights cost
template <class Found>
void fill(Run& run, const Found& solution, const CostFunction& objective) {
    run.status = static_cast<RunStatus>(solution.status);
    fill(run, solution.planning);
    if (solution.certificate) {
        const Certificate& certificate = *solution.certificate;
        run.certificate = {certificate.is_given, certificate.worlds, certificate.failures, certificate.attempts};
    }
    if (solution.status != Status::solved) {
        run.nearest_approach_m = solution.nearest_approach_m;
        return;
    }
    run.cost = solution.cost;
    const auto& flight = solution.execution.value();
    run.flight = FlightFigures{flight.outcome,  cost_of(flight, objective), flight.energy_j,      flight.duration_s,
                               flight.length_m, flight.min_clearance_m,     goal_error_of(flight)};
}

/// @param search is given the run, and returns the plan that solves the problem, if there is one
/// @param evaluate flies it after the clock has stopped
template <class Search, class Evaluate>
Run timed(std::uint32_t seed, const Search& search, const Evaluate& evaluate) {
    Run run;
    run.seed = seed;
    decltype(search(run)) solved;
    const auto begin = std::chrono::steady_clock::now();
    try {
        solved = search(run);
    } catch (const InputError& error) {
        run.status = RunStatus::impossible;
        run.error = error.what();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        run.status = RunStatus::error;
        run.error = error.what();
    }
    run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (solved) {
        run.in_worlds = evaluate(*solved);
    }
    return run;
}

/// What all searches of an experiment are asked.
template <class Options>
Options options_of(const ExperimentSetup& setup) {
    Options how;
    how.stop = setup.stop;
    how.stop_at_first_solution = setup.stops_at_first;
    how.map_cache = setup.map_cache;
    return how;
}

class PlanarExperiment : public CampaignExperiment {
 public:
    /// @param map to be used; nullptr where each run reads it from the cache, as programs do, or needs none
    PlanarExperiment(const ExperimentSetup& setup, std::shared_ptr<const AeroMap> map,
                     std::shared_ptr<PlanEvaluation> evaluation)
        : setup_(setup), map_(std::move(map)), evaluation_(std::move(evaluation)) {}

    Run attempt(const PlannerSetup& planner, std::uint32_t seed) override {
        Problem problem = std::get<Problem>(setup_.problem);
        apply(planner, problem.planner);
        problem.planner.seed = seed;
        auto how = options_of<SolveOptions>(setup_);
        how.map = map_;
        return timed(
            seed,
            [&](Run& run) {
                Solution solution = solve(problem, how);
                fill(run, solution, problem.planner.objective);
                return solution.status == Status::solved ? std::move(solution.plan) : std::nullopt;
            },
            [&](const Plan& plan) {
                return evaluation_ && !setup_.stop.stop_requested() ? std::optional(evaluation_->evaluate(plan))
                                                                    : std::nullopt;
            });
    }

 private:
    ExperimentSetup setup_;
    std::shared_ptr<const AeroMap> map_;
    std::shared_ptr<PlanEvaluation> evaluation_;
};

class SpaceExperiment : public CampaignExperiment {
 public:
    SpaceExperiment(const ExperimentSetup& setup, std::shared_ptr<const SpacePlanEvaluation> evaluation)
        : setup_(setup), evaluation_(std::move(evaluation)) {}

    Run attempt(const PlannerSetup& planner, std::uint32_t seed) override {
        SpaceProblem problem = std::get<SpaceProblem>(setup_.problem);
        apply(planner, problem.planner);
        problem.planner.seed = seed;
        return timed(
            seed,
            [&](Run& run) {
                throw_if_any(space_planning_errors(problem));
                SpaceSearchResult found =
                    solve(std::make_shared<const SpaceProblemModel>(problem), options_of<SpaceSolveOptions>(setup_));
                fill(run, found, problem.planner.objective);
                return found.status == Status::solved ? std::optional(OrderedPlan{*found.plan, found.order})
                                                      : std::nullopt;
            },
            [&](const OrderedPlan& solved) {
                return evaluation_ ? evaluation_->evaluate(solved.plan, solved.order, setup_.stop) : std::nullopt;
            });
    }

 private:
    /// A plan, and in which order it visits targets.
    struct OrderedPlan {
        SpacePlan plan;
        std::optional<VisitOrder> order;
    };

    ExperimentSetup setup_;
    std::shared_ptr<const SpacePlanEvaluation> evaluation_;
};

bool needs_map_for_any(Problem problem, const std::vector<PlannerSetup>& planners) {
    return std::ranges::any_of(planners, [&problem](const PlannerSetup& planner) {
        problem.planner.variant = planner.variant;
        return needs_map(problem, false);
    });
}

/// Whether the cache holds the whole map of a problem.
bool is_in_cache(const Problem& problem, const std::filesystem::path& cache) {
    return !cache.empty() && make_flight_model(problem)->make_map(problem.bounds, cache)->filled_share() == 1;
}

/// Builds the map of a plane before the runs, and makes experiments that share it.
class PlanarMaker {
 public:
    PlanarMaker(const ExperimentSetup& setup, const std::vector<PlannerSetup>& planners, int jobs,
                const std::function<void(double)>& on_map_progress) {
        const auto& problem = std::get<Problem>(setup.problem);
        const bool is_evaluated = setup.evaluated_in.has_value();
        if ((needs_map_for_any(problem, planners) || is_evaluated) && problem.aero.enabled &&
            !setup.stop.stop_requested()) {
            map_ = make_flight_model(problem)->make_whole_map(problem.bounds, jobs, on_map_progress, setup.map_cache);
        }
        if (is_evaluated && !setup.stop.stop_requested()) {
            evaluation_ = std::make_shared<PlanEvaluation>(std::get<Problem>(*setup.evaluated_in), setup.worlds, map_);
        }
        if (map_ && is_in_cache(problem, setup.map_cache)) {
            map_.reset();
        }
    }
    [[nodiscard]] std::unique_ptr<CampaignExperiment> make(const ExperimentSetup& setup) const {
        return std::make_unique<PlanarExperiment>(setup, map_, evaluation_);
    }

 private:
    std::shared_ptr<const AeroMap> map_;
    std::shared_ptr<PlanEvaluation> evaluation_;
};

/// Surfaces in space are evaluated where flights ask for them: there is nothing to build.
class SpaceMaker {
 public:
    explicit SpaceMaker(const ExperimentSetup& setup) {
        if (setup.evaluated_in.has_value()) {
            evaluation_ =
                std::make_shared<const SpacePlanEvaluation>(std::get<SpaceProblem>(*setup.evaluated_in), setup.worlds);
        }
    }
    [[nodiscard]] std::unique_ptr<CampaignExperiment> make(const ExperimentSetup& setup) const {
        return std::make_unique<SpaceExperiment>(setup, evaluation_);
    }

 private:
    std::shared_ptr<const SpacePlanEvaluation> evaluation_;
};

template <class Maker>
std::vector<std::unique_ptr<CampaignExperiment>> made(ExperimentSetup setup,
                                                      const std::vector<CostFunction>& objectives, const Maker& maker) {
    std::vector<std::unique_ptr<CampaignExperiment>> experiments;
    for (const CostFunction& objective : objectives) {
        planner_of(setup.problem).objective = objective;
        experiments.push_back(maker.make(setup));
    }
    return experiments;
}

std::vector<KeyError> planning_errors(const Problem& problem) {
    return problem_errors(problem);
}
std::vector<KeyError> planning_errors(const SpaceProblem& problem) {
    std::vector<KeyError> errors = space_problem_errors(problem);
    return errors.empty() ? space_planning_errors(problem) : errors;
}

}  // namespace

std::vector<std::unique_ptr<CampaignExperiment>> experiments_of(const ExperimentSetup& setup,
                                                                const std::vector<CostFunction>& objectives,
                                                                const std::vector<PlannerSetup>& planners, int jobs,
                                                                const std::function<void(double)>& on_map_progress) {
    if (std::holds_alternative<SpaceProblem>(setup.problem)) {
        return made(setup, objectives, SpaceMaker(setup));
    }
    return made(setup, objectives, PlanarMaker(setup, planners, jobs, on_map_progress));
}

void apply(const PlannerSetup& planner, PlannerSettings& settings) {
    settings.variant = planner.variant;
    settings.algorithm = planner.algorithm;
    if (planner.margin_m) {
        settings.safety_margin_m = *planner.margin_m;
    }
    // Parameters of the problem may be those of another algorithm.
    std::erase_if(settings.parameters,
                  [&](const auto& parameter) { return algorithm_parameter(settings, parameter.first) == nullptr; });
    for (const auto& [name, value] : planner.parameters) {
        settings.parameters[name] = value;
    }
}

std::string error_of_combination(AnyProblem problem, const PlannerSetup& planner) {
    PlannerSettings& settings = planner_of(problem);
    apply(planner, settings);
    for (const auto& [name, value] : planner.parameters) {
        if (algorithm_parameter(settings, name) == nullptr) {
            return planner.name() + ": the algorithm has no parameter " + name + " for this variant";
        }
    }
    for (const KeyError& error : std::visit([](const auto& of) { return planning_errors(of); }, problem)) {
        if (error.key.starts_with("planner.")) {
            return planner.name() + ": " + error.key + " " + error.message;
        }
    }
    return "";
}

}  // namespace downwash::bench
