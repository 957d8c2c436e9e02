#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/plan_origin.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/replan_arguments.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/search_results.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/planner/takeover.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/solution_file.hpp"

namespace downwash::cli {
namespace {

/// How the rest of the earlier plan flies in the problem as it is now.
Replanned fly_rest(const ReplanArguments& given, const Takeover& from, const PlannableProblem& now) {
    const Problem& problem = now.problem;
    const Execution rest = execute(*now.model, start_state(*now.model, problem.start), from.rest.reference, from.left,
                                   problem.aero.enabled);
    return replanned_from(given, from, rest.outcome, cost_of(rest, problem.planner.objective));
}

ExitCode run(const ReplanArguments& given) {
    if (is_space_problem_file(given.problem)) {
        return replan_in_space(given);
    }
    Interruption interruption(given.limits);
    require_whole_plan(given.plan);
    const Takeover from = takeover_of(given, read_problem(problem_of_plan(given)));
    std::vector<LocatedError> warnings;
    const PlannableProblem plannable =
        read_plannable_problem(given.problem, leaving_rest(given, from), given.is_quiet ? nullptr : print_outdated,
                               noting(warnings, given.is_quiet));
    const Problem& read = plannable.problem;
    const std::filesystem::path out =
        folder_beside_plan(given.out, default_folder(read), "-replanned", plan_file(given.plan));
    require_readable_again(read, out);
    RunFolder folder = claimed_folder(out, read, given.problem, given.force);

    SolveOptions options;
    options.threads = given.threads;
    options.stop_at_first_solution = given.stop_at_first;
    options.keep_tree = true;
    options.finds_stops = true;
    options.known_plan = from.rest;
    options.stop = interruption.token();
    interruption.expect_results();
    options.map_cache = cache_folder(given.no_cache);
    Replanned replanned = fly_rest(given, from, plannable);
    Solution solution;
    {
        ProgressDisplay display(given.is_quiet);
        display.say(takeover_announcement(read.name, read.planner.seed, replanned));
        options.on_progress = [&](const Progress& progress) { display.show(progress); };
        solution = downwash::solve(plannable, options);
    }
    if (solution.plan) {
        replanned.same_reference_s = same_reference_s(*solution.plan, from.rest);
    }
    solution.replanned = std::move(replanned);
    write_search(folder, plannable, solution, std::move(warnings),
                 {given.problem, given.threads, given.is_quiet, given.as_json});
    return interruption.code() != ExitCode::done ? interruption.code() : exit_code_of(solution);
}

}  // namespace

std::string problem_of_plan(const ReplanArguments& given) {
    const std::filesystem::path effective =
        std::filesystem::path(plan_file(given.plan)).parent_path() / "effective.yaml";
    std::error_code error;
    return std::filesystem::exists(effective, error) ? effective.string() : given.problem;
}

std::int64_t tick_at(const ReplanArguments& given, double end_s, double tick_s) {
    if (!(given.at_s >= 0 && given.at_s <= end_s)) {
        throw UsageError("--after is {:g}: expected 0 to {:g} s, where the reference of the plan ends", given.at_s,
                         end_s);
    }
    return std::llround(given.at_s / tick_s);
}

std::string takeover_announcement(const std::string& name, std::uint32_t seed, const Replanned& from) {
    return fmt::format("{}: planning again from {:.2f} s of {}, whose rest ends {} here; seed {}", name, from.t_s,
                       from.plan, name_of(from.rest_outcome), seed);
}

void add_replan(Command program, Action& action) {
    auto [command, given] = add_command<ReplanArguments>(
        program, action, "replan",
        "Plan again for a vehicle that follows a plan, from a moment of it on, in a problem that has "
        "changed; write the same files as solve",
        run);
    add_problem(command, given.problem);
    add_plan(command, given.plan);
    command.add_option("--after S", given.at_s, "moment of the plan from which the new one takes over, in s")
        .required();
    given.planner.add_of_search(command);
    add_threads(command, given.threads);
    add_out(command, "DIR", given.out, "folder for the results; default downwash-out/NAME-VARIANT-SEED-replanned/");
    add_force(command, given.force);
    add_wall_limit(command, given.limits.wall_s, "then the best plan so far is written");
    command.add_flag("--stop-at-first", given.stop_at_first, "end with the first plan that is accepted");
    add_no_cache(command, given.no_cache);
    add_quiet(command, given.is_quiet);
    add_json(command, given.as_json, "solution.json");
}

}  // namespace downwash::cli
