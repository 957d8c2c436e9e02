#include "downwash/bench/campaign_run.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <variant>

#include "downwash/base/parallel.hpp"
#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
#include "downwash/bench/campaign_experiment.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/saved_copy.hpp"
#include "downwash/problems/any_problem.hpp"

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
    for (const AnyProblem& problem : read.problems) {
        settings.emplace_back("problem " + problem_name(problem), problem_sha256(problem));
    }
    for (const AnyProblem& problem : read.evaluated_in) {
        settings.emplace_back("evaluated in " + problem_name(problem), problem_sha256(problem));
    }
    for (std::size_t i = 0; i < c.expect.size(); ++i) {
        settings.emplace_back("expectation " + std::to_string(i + 1), target_text(c.expect[i]));
    }
    return settings;
}

/// The objectives for which a campaign plans a problem: those of the campaign, or the problem's own.
std::vector<CostFunction> objectives_of(const Campaign& campaign, const AnyProblem& problem) {
    if (!campaign.objectives) {
        return {planner_of(problem).objective};
    }
    return {campaign.objectives->begin(), campaign.objectives->end()};
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

/// Of the first problem in a plane and of the first in space; empty when a planner can plan both.
std::string error_of_combination(const ReadCampaign& read, const PlannerSetup& planner) {
    for (std::size_t family = 0; family < std::variant_size_v<AnyProblem>; ++family) {
        const auto first = std::ranges::find(read.problems, family, &AnyProblem::index);
        if (first != read.problems.end()) {
            if (std::string error = error_of_combination(*first, planner); !error.empty()) {
                return error;
            }
        }
    }
    return "";
}

/// A problem with the limits of a campaign.
AnyProblem limited(AnyProblem problem, const CampaignPlan& plan, const Campaign& campaign) {
    PlannerSettings& settings = planner_of(problem);
    settings.time_limit_s = plan.time_limit_s;
    settings.max_iterations = campaign.max_iterations;
    settings.check_execution = settings.check_execution && campaign.check_execution;
    settings.certify = settings.certify && campaign.certify;
    return problem;
}

/// All experiments of a campaign, in the order of its plan.
std::vector<std::unique_ptr<CampaignExperiment>> all_experiments(const ReadCampaign& read, const CampaignPlan& plan,
                                                                 const CampaignRunOptions& options, int jobs) {
    std::vector<std::unique_ptr<CampaignExperiment>> all;
    for (std::size_t p = 0; p < read.problems.size(); ++p) {
        const AnyProblem problem = limited(read.problems[p], plan, read.campaign);
        const AnyProblem& judging = read.evaluated_in.empty() ? problem : read.evaluated_in.at(p);
        const bool is_evaluated = plan.evaluation_worlds > 0 && uncertainty_of(judging).has_value();
        const ExperimentSetup setup{problem,
                                    is_evaluated ? std::optional(judging) : std::nullopt,
                                    plan.evaluation_worlds,
                                    plan.stop_at_first_solution,
                                    options.map_cache,
                                    options.stop};
        const auto on_map_progress = [&](double share) {
            if (options.on_map_progress) {
                options.on_map_progress(problem_name(problem), share);
            }
        };
        for (auto& experiment :
             experiments_of(setup, objectives_of(read.campaign, problem), plan.planners, jobs, on_map_progress)) {
            all.push_back(std::move(experiment));
        }
    }
    return all;
}

}  // namespace

CampaignPlan plan_of(const ReadCampaign& read, const std::optional<ShardRequest>& shard) {
    const Campaign& c = read.campaign;
    CampaignPlan plan;
    plan.settings = settings_of(read, shard.has_value());
    for (const AnyProblem& problem : read.problems) {
        for (const CostFunction& objective : objectives_of(c, problem)) {
            plan.experiments.push_back({problem_name(problem), text_of(objective)});
        }
    }
    const std::vector<ParameterValues> parameter_sets =
        c.parameters.empty() ? std::vector<ParameterValues>(1) : c.parameters;
    for (const Variant variant : c.variants) {
        for (const std::string& algorithm : c.algorithms) {
            for (const ParameterValues& parameters : parameter_sets) {
                PlannerSetup planner{variant, algorithm, {}, parameters};
                if (std::string error = error_of_combination(read, planner); !error.empty()) {
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

    const auto experiments =
        tasks.empty() ? std::vector<std::unique_ptr<CampaignExperiment>>() : all_experiments(read, plan, options, jobs);
    std::mutex writing;
    std::atomic<std::size_t> out_of_memory = 0;
    const auto do_task = [&](std::size_t i) {
        if (options.stop.stop_requested()) {
            return;
        }
        const Task& task = tasks[i];
        try {
            Run run = experiments[task.experiment]->attempt(plan.planners[task.planner], task.seed);
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
