#include "downwash/bench/campaign_run.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <new>
#include <utility>

#include "downwash/base/parallel.hpp"
#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/plan_evaluation.hpp"
#include "downwash/bench/saved_copy.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/problem_writer.hpp"

namespace downwash::bench {
namespace {

std::string target_text(const CampaignExpectation& target) {
    std::string text(downwash::name_of(target.variant));
    text += target.algorithm ? " " + *target.algorithm : "";
    const auto add = [&](const char* name, const std::optional<double>& value) {
        text += value ? std::string(" ") + name + " " + to_text(*value) : "";
    };
    add("solved_ratio", target.solved_ratio);
    add("failed_flights",
        target.failed_flights ? std::optional(static_cast<double>(*target.failed_flights)) : std::nullopt);
    add("first_solution_median_s", target.first_solution_median_s);
    add("first_solution_95_s", target.first_solution_95_s);
    add("verified_median_s", target.verified_median_s);
    add("cost_after_s", target.cost_after_s);
    add("cost_to_best", target.cost_to_best);
    text += target.cheaper_than ? " cheaper_than " + *target.cheaper_than : "";
    add("cheaper_than_after_s", target.cheaper_than_after_s);
    add("max_failure_share", target.max_failure_share);
    add("certified_ratio", target.certified_ratio);
    add("first_certified_median_s", target.first_certified_median_s);
    return text;
}

/// Shards run on many computers under one setting: what one of them has says nothing about the others.
int job_count(const Campaign& campaign, bool is_sharded) {
    return static_cast<int>(campaign.jobs.value_or(is_sharded ? 1U : std::min(processor_count(), 256U)));
}

std::optional<double> time_limit_of(const Campaign& campaign) {
    return campaign.max_iterations ? campaign.time_limit_s
                                   : std::optional(campaign.time_limit_s.value_or(default_time_limit_s));
}

std::vector<std::pair<std::string, std::string>> settings_of(const ReadCampaign& read, bool is_sharded) {
    const Campaign& c = read.campaign;
    const auto number_or_none = [](const std::optional<double>& value) { return value ? to_text(*value) : "none"; };
    std::vector<std::pair<std::string, std::string>> settings{
        {"campaign", c.name},
        {"description", c.description.empty() ? "none" : c.description},
        {"version", std::string(version())},
        {"commit", std::string(source_commit())},
        {"jobs", std::to_string(job_count(c, is_sharded))},
        {"time_limit_s", number_or_none(time_limit_of(c))},
        {"max_iterations", c.max_iterations ? std::to_string(*c.max_iterations) : "none"},
        {"stop_at_first_solution", c.stop_at_first_solution ? "true" : "false"},
        {"as_believed", c.as_believed ? "true" : "false"},
        {"check_execution", c.check_execution ? "true" : "false"},
        {"certify", c.certify ? "true" : "false"},
        {"evaluation_worlds", std::to_string(c.evaluation_worlds)},
        {"variants", joined(c.variants, " ", [](Variant v) { return downwash::name_of(v); })},
        {"algorithms", joined(c.algorithms, " ")},
        {"objectives", c.objectives ? joined(*c.objectives, " ", [](Objective o) { return downwash::name_of(o); })
                                    : "each problem's own"},
        {"margins_m",
         c.margins_m ? joined(*c.margins_m, " ", [](double m) { return to_text(m); }) : "each problem's own"},
        {"parameters",
         c.parameters.empty()
             ? "each problem's own"
             : joined(c.parameters, " ", [](const ParameterValues& set) { return "{" + text_of(set) + "}"; })},
        {"seeds", seeds_text(c.seeds.all())}};
    if (!is_sharded) {  // continued on this computer only
        settings.insert(settings.begin() + 4, {{"host", host_name()}, {"processor", processor()}});
    }
    for (const Problem& problem : read.problems) {
        settings.emplace_back("problem " + problem.name, problem_sha256(problem));
    }
    for (const Problem& problem : read.evaluated_in) {
        settings.emplace_back("evaluated in " + problem.name, problem_sha256(problem));
    }
    for (std::size_t i = 0; i < c.expect.size(); ++i) {
        settings.emplace_back("expectation " + std::to_string(i + 1), target_text(c.expect[i]));
    }
    return settings;
}

/// The objectives for which a campaign plans a problem: those of the campaign, or the problem's own.
std::vector<CostFunction> objectives_of(const Campaign& campaign, const Problem& problem) {
    if (!campaign.objectives) {
        return {problem.planner.objective};
    }
    return {campaign.objectives->begin(), campaign.objectives->end()};
}

void apply(const PlannerSetup& planner, Problem& problem) {
    problem.planner.variant = planner.variant;
    problem.planner.algorithm = planner.algorithm;
    if (planner.margin_m) {
        problem.planner.safety_margin_m = *planner.margin_m;
    }
    // Parameters of the problem may be those of another algorithm.
    std::erase_if(problem.planner.parameters, [&](const auto& parameter) {
        return algorithm_parameter(problem.planner, parameter.first) == nullptr;
    });
    for (const auto& [name, value] : planner.parameters) {
        problem.planner.parameters[name] = value;
    }
}

/// Why a variant cannot be planned with an algorithm and parameters; empty when it can.
std::string error_of_combination(Problem problem, const PlannerSetup& planner) {
    apply(planner, problem);
    for (const auto& [name, value] : planner.parameters) {
        if (algorithm_parameter(problem.planner, name) == nullptr) {
            return planner.name() + ": the algorithm has no parameter " + name + " for this variant";
        }
    }
    for (const KeyError& error : problem_errors(problem)) {
        if (error.key.starts_with("planner.")) {
            return planner.name() + ": " + error.key + " " + error.message;
        }
    }
    return "";
}

/// A run that is missing.
struct Task {
    std::size_t experiment, planner;
    std::uint32_t seed;
};

/// Seeds outermost, so that an interrupted campaign has about as many runs of every planner.
/// @param shard its number, from 1; empty: all runs
std::vector<Task> runs_of(const CampaignPlan& plan, std::optional<std::uint64_t> shard) {
    const std::optional<ShardAssignment> shards = shard ? std::optional(ShardAssignment(plan)) : std::nullopt;
    std::vector<Task> tasks;
    for (std::size_t s = 0; s < plan.seeds.size(); ++s) {
        for (std::size_t e = 0; e < plan.experiments.size(); ++e) {
            for (std::size_t p = 0; p < plan.planners.size(); ++p) {
                if (!shards || shards->shard_of(e, p, s) == *shard) {
                    tasks.push_back({e, p, plan.seeds[s]});
                }
            }
        }
    }
    return tasks;
}

void fill(Run& run, const Solution& solution) {
    const SearchRecord& record = solution.planning;
    run.status = static_cast<RunStatus>(solution.status);
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
    if (solution.certificate) {
        const Certificate& certificate = *solution.certificate;
        run.certificate = {certificate.is_given, certificate.worlds, certificate.failures, certificate.attempts};
    }
    if (record.first_certified_wall_s) {
        run.first_certified_s = record.setup_wall_s + *record.first_certified_wall_s;
    }
    if (solution.status != Status::solved) {
        run.nearest_approach_m = solution.nearest_approach_m;
        return;
    }
    run.cost = solution.cost;
    const Execution& flight = solution.execution.value();
    run.flight = FlightFigures{flight.outcome,  solution.execution_cost, flight.energy_j,    flight.duration_s,
                               flight.length_m, flight.min_clearance_m,  flight.goal_error_m};
}

/// One run: the search and the flight of its plan. An error is in the result, never thrown, apart from std::bad_alloc:
/// that there was no memory left says nothing about the search.
/// @param how the map to use, the stop token, and whether to stop at the first solution
/// @param evaluation flies the plan after the clock has stopped; nullptr: it is not flown in other worlds
Run attempt(Problem problem, const PlannerSetup& planner, std::uint32_t seed, const SolveOptions& how,
            PlanEvaluation* evaluation) {
    apply(planner, problem);
    problem.planner.seed = seed;
    Run run;
    run.seed = seed;
    std::optional<Plan> solved;
    const auto begin = std::chrono::steady_clock::now();
    try {
        Solution solution = solve(problem, how);
        fill(run, solution);
        solved = solution.status == Status::solved ? std::move(solution.plan) : std::nullopt;
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
    if (evaluation != nullptr && solved && !how.stop.stop_requested()) {
        run.in_worlds = evaluation->evaluate(*solved);
    }
    return run;
}

/// Whether the cache holds the whole map of a problem.
bool is_in_cache(const Problem& problem, const std::filesystem::path& cache) {
    return !cache.empty() && make_flight_model(problem)->make_map(problem.bounds, cache)->filled_share() == 1;
}

static_assert(static_cast<int>(RunStatus::none) == static_cast<int>(Status::none));
static_assert(static_cast<int>(RunStatus::approximate) == static_cast<int>(Status::approximate));
static_assert(static_cast<int>(RunStatus::solved) == static_cast<int>(Status::solved));

}  // namespace

CampaignPlan plan_of(const ReadCampaign& read, const std::optional<ShardRequest>& shard) {
    const Campaign& c = read.campaign;
    CampaignPlan plan;
    plan.settings = settings_of(read, shard.has_value());
    for (const Problem& problem : read.problems) {
        for (const CostFunction& objective : objectives_of(c, problem)) {
            plan.experiments.push_back({problem.name, text_of(objective)});
        }
    }
    const std::vector<ParameterValues> parameter_sets =
        c.parameters.empty() ? std::vector<ParameterValues>(1) : c.parameters;
    for (const Variant variant : c.variants) {
        for (const std::string& algorithm : c.algorithms) {
            for (const ParameterValues& parameters : parameter_sets) {
                PlannerSetup planner{variant, algorithm, {}, parameters};
                if (std::string error = error_of_combination(read.problems.at(0), planner); !error.empty()) {
                    plan.left_out.push_back(std::move(error));
                    continue;
                }
                if (!c.margins_m) {
                    plan.planners.push_back(planner);
                    continue;
                }
                for (const double margin_m : *c.margins_m) {
                    planner.margin_m = margin_m;
                    plan.planners.push_back(planner);
                }
            }
        }
    }
    if (plan.planners.empty()) {
        throw CampaignError("no variant of the campaign can be planned with any of its algorithms: " +
                            plan.left_out.front());
    }
    plan.seeds = c.seeds.all();
    plan.expectations = c.expect;
    plan.time_limit_s = time_limit_of(c);
    plan.stop_at_first_solution = c.stop_at_first_solution;
    plan.evaluation_worlds = c.evaluation_worlds;
    if (shard) {
        plan.shards = shard_plan_of(plan, *shard);
        plan.settings.emplace_back("shards", std::to_string(plan.shards->count));
        plan.settings.emplace_back("shard_costs", costs_text(*plan.shards));
    }
    return plan;
}

CampaignProgress run_campaign(const ReadCampaign& read, const CampaignRunOptions& options) {
    const CampaignPlan plan = plan_of(read, options.shard);
    const auto shard = options.shard ? std::optional(options.shard->number) : std::nullopt;
    SavedCopy saved(options.out, options.saved);
    saved.restore(plan, shard, options.resumes);
    CampaignStore store(options.out, plan, options.resumes, shard);
    std::vector<Task> tasks = runs_of(plan, shard);
    const std::size_t planned = tasks.size();
    std::erase_if(tasks, [&](const Task& task) { return store.has(task.experiment, task.planner, task.seed); });
    const int jobs = job_count(read.campaign, shard.has_value());

    std::vector<Problem> problems;                     // one for each experiment
    std::vector<std::shared_ptr<const AeroMap>> maps;  // empty where each run reads it from the cache, as programs do
    std::vector<std::shared_ptr<PlanEvaluation>> evaluations;  // empty where plans are not flown in other worlds
    const auto plans_need_map = [&](Problem problem) {
        return !tasks.empty() &&
               std::any_of(plan.planners.begin(), plan.planners.end(), [&problem](const PlannerSetup& planner) {
                   problem.planner.variant = planner.variant;
                   return needs_map(problem, false);
               });
    };
    for (std::size_t p = 0; p < read.problems.size(); ++p) {
        Problem problem = read.problems[p];
        const Problem& judging = read.evaluated_in.empty() ? problem : read.evaluated_in.at(p);
        const bool is_evaluated = !tasks.empty() && plan.evaluation_worlds > 0 && judging.uncertainty.has_value();
        problem.planner.time_limit_s = plan.time_limit_s;
        problem.planner.max_iterations = read.campaign.max_iterations;
        problem.planner.check_execution = problem.planner.check_execution && read.campaign.check_execution;
        problem.planner.certify = problem.planner.certify && read.campaign.certify;
        const auto on_map_progress = [&](double share) {
            if (options.on_map_progress) {
                options.on_map_progress(problem.name, share);
            }
        };
        auto map =
            (plans_need_map(problem) || is_evaluated) && problem.aero.enabled && !options.stop.stop_requested()
                ? make_flight_model(problem)->make_whole_map(problem.bounds, jobs, on_map_progress, options.map_cache)
                : nullptr;
        const auto evaluation = is_evaluated && !options.stop.stop_requested()
                                    ? std::make_shared<PlanEvaluation>(judging, plan.evaluation_worlds, map)
                                    : nullptr;
        if (map && is_in_cache(problem, options.map_cache)) {
            map.reset();
        }
        for (const CostFunction& objective : objectives_of(read.campaign, problem)) {
            problem.planner.objective = objective;
            problems.push_back(problem);
            maps.push_back(map);
            evaluations.push_back(evaluation);
        }
    }

    std::mutex writing;
    std::atomic<std::size_t> out_of_memory = 0;
    const auto do_task = [&](std::size_t i) {
        if (options.stop.stop_requested()) {
            return;
        }
        const Task& task = tasks[i];
        SolveOptions how;
        how.stop = options.stop;
        how.stop_at_first_solution = plan.stop_at_first_solution;
        how.map = maps[task.experiment];
        how.map_cache = options.map_cache;
        try {
            Run run = attempt(problems[task.experiment], plan.planners[task.planner], task.seed, how,
                              evaluations[task.experiment].get());
            run.experiment = task.experiment;
            run.planner = task.planner;
            run.made_on = RunMachine{this_machine(), system_load()};
            const std::scoped_lock lock(writing);
            if (!options.stop.stop_requested()) {
                store.add(run);
                saved.save_now_and_then();
            }
        } catch (const std::bad_alloc&) {  // not finished: --resume repeats it
            ++out_of_memory;
        }
    };
    const double earlier = static_cast<double>(store.size());
    const auto on_progress = [&](double share) {
        if (options.on_progress) {
            options.on_progress((earlier + share * static_cast<double>(tasks.size())) / static_cast<double>(planned));
        }
    };
    try {
        run_parallel(tasks.size(), jobs, do_task, on_progress);
    } catch (...) {
        saved.save_if_possible();
        throw;
    }
    saved.save();
    return {planned, store.size(), out_of_memory};
}

}  // namespace downwash::bench
