#include "downwash/planner/solve.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/in_space.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/planner_options.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/search_results.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/remedies.hpp"
#include "downwash/problems/cut_off_goals.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/visit_order.hpp"

namespace downwash::cli {
namespace {

struct SolveArguments {
    std::string problem;
    PlannerOptions planner;
    int threads = default_threads();
    std::optional<std::string> out;
    CommandLimits limits;
    bool stop_at_first = false, no_cache = false, is_quiet = false, as_json = false, tries_remedies = false;
    bool force = false;
};

std::string announcement(const Problem& problem) {
    const PlannerSettings& planner = problem.planner;
    return fmt::format("{}: planning with {} {}, objective {}, seed {}", problem.name, name_of(planner.variant),
                       planner.algorithm, text_of(planner.objective), planner.seed);
}

std::string outcome_of(const Remedy& remedy) {
    if (!remedy.error.empty()) {
        return "cannot be planned: " + remedy.error;
    }
    if (remedy.helps) {
        return fmt::format("certified after {:.1f} s, cost {:.6g}", remedy.wall_s, remedy.cost);
    }
    if (remedy.certificate && remedy.certificate->failures > 0) {
        return fmt::format("not certified: {} of {} worlds fail", remedy.certificate->failures,
                           remedy.certificate->worlds);
    }
    if (!remedy.closed_by.empty()) {
        return "no way in this plane: closed by " + quoted_labels(remedy.closed_by);
    }
    return "not certified in time" +
           (remedy.stopped_by.empty() ? "" : "; collisions with " + most_stopping(remedy.stopped_by));
}

/// Whether all that stood between a plan and its certificate was time.
bool lacked_time(const Solution& solution) {
    return solution.obstruction &&
           (solution.obstruction->cause == unfinished_flight || solution.obstruction->cause == unfinished_certificate);
}

/// @param problem with its goals in the order of the plan
void print_remedies(const Problem& problem, SolveOptions options, bool is_quiet) {
    constexpr double limit_s = 5;
    const std::size_t goals = goals_of(problem).size();
    fmt::print("\nWhat would help, each tried by itself for up to {} s{}:\n\n", limit_s * static_cast<double>(goals),
               goals > 1 ? ", all together for up to a minute" : "");
    std::fflush(stdout);
    ProgressDisplay display(is_quiet);
    options.on_progress = [&](const Progress& progress) { display.show(progress); };
    static_cast<void>(try_remedies(problem, options, limit_s, [&](const Remedy& remedy) {
        display.clear();
        fmt::print("  {:<41} {}\n", remedy.change, outcome_of(remedy));
        std::fflush(stdout);
    }));
}

ExitCode run(const SolveArguments& given) {
    if (is_space_problem_file(given.problem)) {
        if (given.tries_remedies) {
            throw UsageError("--remedies changes problems in a vertical plane, and this one is in space: leave it out");
        }
        return solve_in_space({given.problem, given.planner, given.threads, given.out, given.limits,
                               given.stop_at_first, given.no_cache, given.is_quiet, given.as_json, given.force});
    }
    Interruption interruption(given.limits);
    std::vector<LocatedError> warnings;
    const PlannableProblem plannable = read_plannable_problem(
        given.problem, [&given](Problem& settings) { given.planner.apply_to(settings); },
        noting_outdated(warnings, given.is_quiet), noting(warnings, given.is_quiet));
    const Problem& read = plannable.problem;
    const std::filesystem::path out = given.out ? std::filesystem::path(*given.out) : default_folder(read);
    require_readable_again(read, out);
    RunFolder folder = claimed_folder(out, read, given.problem, given.force);

    SolveOptions options;
    options.threads = given.threads;
    options.stop_at_first_solution = given.stop_at_first;
    options.keep_tree = true;
    options.finds_stops = true;
    options.stop = interruption.token();
    interruption.expect_results();
    options.map_cache = cache_folder(given.no_cache);
    Solution solution;
    {
        ProgressDisplay display(given.is_quiet);
        display.say(announcement(read));
        options.on_progress = [&](const Progress& progress) { display.show(progress); };
        solution = downwash::solve(plannable, options);
    }
    write_search(folder, plannable, solution, std::move(warnings),
                 {given.problem, given.threads, given.is_quiet, given.as_json});
    if (given.tries_remedies && read.uncertainty && solution.status != Status::solved && !solution.interrupted) {
        if (lacked_time(solution)) {
            fmt::print("\nMore time would help (--time-limit); nothing else was tried, because no plan has failed.\n");
        } else {
            const bool visits_all = solution.order && solution.order->left_out.empty();
            print_remedies(visits_all ? in_order(read, solution.order) : read, options, given.is_quiet);
        }
    }
    return interruption.code() != ExitCode::done ? interruption.code() : exit_code_of(solution);
}

}  // namespace

void add_solve(Command program, Action& action) {
    auto [command, given] = add_command<SolveArguments>(
        program, action, "solve",
        "Plan with MP-ARM, the motion planner for aerial robotic manipulators, or its dynamics-aware "
        "(MP-ARM-DA) or aerodynamics-aware (MP-ARM-ADA) variant; execute the plan with direct "
        "aerodynamics; write solution.json, trajectory.csv, tree.csv, effective.yaml and report.html",
        run);
    add_problem(command, given.problem);
    given.planner.add_of_search(command);
    add_threads(command, given.threads);
    add_out(command, "DIR", given.out, "folder for the results; default downwash-out/NAME-VARIANT-SEED/");
    add_force(command, given.force);
    add_wall_limit(command, given.limits.wall_s, "then the best plan so far is written");
    command
        .add_option("--max-memory SIZE", given.limits.memory_bytes,
                    "memory of the whole command, as 500MiB or 4GiB; where a search grows beyond it, it ends, and the "
                    "best plan "
                    "so far is written")
        .in_bytes();
    command.add_flag("--stop-at-first", given.stop_at_first, "end with the first plan that is accepted");
    add_no_cache(command, given.no_cache);
    add_quiet(command, given.is_quiet);
    Option remedies =
        command.add_flag("--remedies", given.tries_remedies,
                         "where no plan gets its certificate, try what would help: another place or tolerance of the "
                         "goal, more margin, less speed, a stiffer controller, better knowledge; 5 s each, for each of "
                         "several goals, and "
                         "a minute at most");
    add_json(command, given.as_json, "solution.json");
    command.option("--json").excludes(remedies);
}

}  // namespace downwash::cli
