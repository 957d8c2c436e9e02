#include "downwash/planner/solve.hpp"

#include <fmt/core.h>

#include <optional>
#include <utility>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/planner_options.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

struct SolveArguments {
    std::string problem;
    PlannerOptions planner;
    int threads = default_threads();
    std::optional<std::string> out;
    bool stop_at_first = false, no_cache = false, is_quiet = false, as_json = false;

    void add_to(CLI::App& command);
    [[nodiscard]] ExitCode run() const;
};

std::string announcement(const Problem& problem) {
    const PlannerSettings& planner = problem.planner;
    return fmt::format("{}: planning with {} {}, objective {}, seed {}", problem.name, name_of(planner.variant),
                       planner.algorithm, text_of(planner.objective), planner.seed);
}

ExitCode SolveArguments::run() const {
    const Interruption interruption;
    const Problem read = read_problem(problem, [this](Problem& settings) { planner.apply(settings); });
    const OutputFolder folder(out ? std::filesystem::path(*out) : default_folder(read));

    SolveOptions options;
    options.threads = threads;
    options.stop_at_first_solution = stop_at_first;
    options.keep_tree = true;
    options.stop = interruption.token();
    options.map_cache = cache_folder(no_cache);
    Solution solution;
    {
        ProgressDisplay display(is_quiet);
        display.say(announcement(read));
        options.on_map_progress = [&](double share) { display.show("aero map", share); };
        options.on_progress = [&](const Progress& progress) { display.show(progress); };
        solution = downwash::solve(read, options);
    }
    const RunRecord record = write_results(folder, read, problem, solution);
    if (solution.map != nullptr || !solution.interrupted) {  // whoever interrupted does not want to wait for a map
        write_page(folder, record, solution.map, options.map_cache, is_quiet);
    } else {
        remove_page(folder);
    }
    fmt::print("{}", as_json ? record.solution_text : summary_of(verdict_on_search(solution), solution, folder.path()));
    return solution.interrupted ? interruption.code() : exit_code_of(solution);
}

void SolveArguments::add_to(CLI::App& command) {
    add_problem(command, problem);
    planner.add_to(command);
    add_threads(command, threads);
    command.add_option("--out", out, "folder for the results; default downwash-out/NAME-VARIANT-SEED/")
        ->type_name("DIR");
    command.add_flag("--stop-at-first", stop_at_first, "end with the first plan that is accepted");
    add_no_cache(command, no_cache);
    add_quiet(command, is_quiet);
    add_json(command, as_json, "print solution.json on standard output instead of a summary");
}

}  // namespace

void add_solve(CLI::App& program, Action& action) {
    add_command<SolveArguments>(
        program, action, "solve",
        "Plan with MP-ARM, the motion planner for aerial robotic manipulators, or its dynamics-aware "
        "(MP-ARM-DA) or aerodynamics-aware (MP-ARM-ADA) variant; execute the plan with direct aerodynamics; write "
        "solution.json, trajectory.csv, tree.csv, effective.yaml and report.html");
}

}  // namespace downwash::cli
