#include "downwash/planner/solve.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <thread>

#include "downwash/cli/cache_folder.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/planner_options.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

constexpr int most_threads = 256;

struct SolveArguments {
    std::string problem;
    PlannerOptions planner;
    int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
    std::optional<std::string> out;
    bool stop_at_first = false;
    bool no_cache = false;
    bool is_quiet = false;
    bool as_json = false;
};

std::string announcement(const Problem& problem) {
    const PlannerSettings& planner = problem.planner;
    return fmt::format("{}: planning with {} {}, objective {}, seed {}", problem.name, name_of(planner.variant),
                       planner.algorithm, text_of(planner.objective), planner.seed);
}

ExitCode run(const SolveArguments& arguments) {
    const Interruption interruption;
    const PlannableProblem plannable =
        read_plannable_problem(arguments.problem, [&](Problem& read) { arguments.planner.apply(read); });
    const Problem& problem = plannable.problem;
    const OutputFolder folder(arguments.out ? std::filesystem::path(*arguments.out) : default_folder(problem));

    SolveOptions options;
    options.threads = arguments.threads;
    options.stop_at_first_solution = arguments.stop_at_first;
    options.keep_tree = true;
    options.stop = interruption.token();
    options.map_cache = arguments.no_cache ? std::filesystem::path() : cache_folder();
    Solution solution;
    {
        ProgressDisplay display(arguments.is_quiet);
        display.say(announcement(problem));
        options.on_map_progress = [&](double share) { display.show("aero map", share); };
        options.on_progress = [&](const Progress& progress) { display.show(progress); };
        solution = solve(plannable, options);
    }
    const std::string json = write_results(folder, problem, arguments.problem, solution);
    if (solution.map != nullptr || !solution.interrupted) {  // building a map now would keep who interrupted waiting
        write_page(folder, solution.map, options.map_cache, arguments.is_quiet);
    } else {
        std::error_code ignored;
        std::filesystem::remove(folder.path() / "report.html", ignored);  // of an earlier run
    }
    fmt::print("{}", arguments.as_json ? json : summary_of(verdict_on_search(solution), solution, folder.path()));
    return solution.interrupted ? interruption.code() : exit_code_of(solution);
}

}  // namespace

void add_solve(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<SolveArguments>();
    CLI::App* command = program.add_subcommand("solve",
                                               "Plan, fly the plan with direct aerodynamics, and write solution.json, "
                                               "trajectory.csv, tree.csv, effective.yaml "
                                               "and report.html");
    command->add_option("PROBLEM", arguments->problem, "problem file")->required();
    arguments->planner.add_to(*command);
    command
        ->add_option("--threads", arguments->threads,
                     "threads that build the aero map and fly edges: 1 to 256; the result does not depend on it; "
                     "default: one per processor")
        ->type_name("N")
        ->check(CLI::Range(1, most_threads));
    command->add_option("--out", arguments->out, "folder of the results; default downwash-out/NAME-VARIANT-SEED/")
        ->type_name("DIR");
    command->add_flag("--stop-at-first", arguments->stop_at_first, "end with the first plan that is accepted");
    command->add_flag("--no-cache", arguments->no_cache,
                      "neither read nor write the cache of aero maps in $XDG_CACHE_HOME/downwash (~/.cache/downwash)");
    command->add_flag("--quiet", arguments->is_quiet, "only errors on standard error, no progress");
    command->add_flag("--json", arguments->as_json, "print solution.json on standard output instead of a summary");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
