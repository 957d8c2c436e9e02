#include "downwash/simulation/execution.hpp"

#include <fmt/core.h>

#include <array>
#include <chrono>
#include <optional>
#include <string_view>

#include "downwash/cli/cache_folder.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/results/solution_file.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

struct ExecuteArguments {
    std::string problem;
    std::string plan;
    std::string aero = "on";
    std::optional<std::string> out;
    bool no_cache = false;
    bool as_json = false;
};

/// The problem with the planner settings that the plan was made with, as far as its file tells.
Problem as_planned(Problem problem, const Solution& solution) {
    problem.planner.variant = solution.variant;
    problem.planner.algorithm = solution.algorithm;
    problem.planner.objective = solution.objective;
    problem.planner.seed = solution.seed;
    return problem;
}

/// Whether results in a folder would replace the plan's own file.
bool holds_plan(const fs::path& folder, const std::string& plan) {
    std::error_code error;
    return fs::equivalent(folder / "solution.json", plan, error);
}

fs::path folder_for(const ExecuteArguments& arguments, const Problem& problem) {
    if (!arguments.out) {
        const fs::path folder = default_folder(problem);
        return holds_plan(folder, arguments.plan) ? fs::path(folder.string() + "-executed") : folder;
    }
    if (holds_plan(*arguments.out, arguments.plan)) {
        throw UsageError("--out " + *arguments.out + " holds the plan itself, which would be replaced; choose another");
    }
    return *arguments.out;
}

void fly(const Problem& problem, bool aero, Solution& solution) {
    const auto begin = std::chrono::steady_clock::now();
    const auto model = make_flight_model(problem);
    solution.execution =
        execute(*model, start_state(*model, problem.start), solution.plan->reference, goals_of(problem), aero);
    solution.execution_cost = cost_of(*solution.execution, solution.objective);
    solution.planning.flight_wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

ExitCode run(const ExecuteArguments& arguments) {
    const Interruption interruption;
    Problem problem = read_problem(arguments.problem);
    Solution solution = read_solution(arguments.plan, problem);
    problem = as_planned(std::move(problem), solution);
    const OutputFolder folder(folder_for(arguments, problem));
    fly(problem, arguments.aero == "on", solution);
    const std::string json = write_results(folder, problem, arguments.problem, solution);
    write_page(folder, nullptr, arguments.no_cache ? fs::path() : cache_folder());
    fmt::print("{}",
               arguments.as_json ? json : summary_of(verdict_on_flight(*solution.execution), solution, folder.path()));
    if (interruption.code() != ExitCode::done) {
        return interruption.code();
    }
    return solution.execution->outcome == Outcome::ok ? ExitCode::done : ExitCode::flight_failed;
}

}  // namespace

void add_execute(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<ExecuteArguments>();
    CLI::App* command = program.add_subcommand(
        "execute", "Fly a plan again in closed loop; writes what solve writes, with the record of the search copied");
    command->add_option("PROBLEM", arguments->problem, "problem file")->required();
    command->add_option("--plan", arguments->plan, "solution.json that holds the plan")->type_name("FILE")->required();
    CLI::Option* aero = command->add_option("--aero", arguments->aero,
                                            "on: surface effects evaluated directly (default); off: free air");
    require_one_of(*aero, std::array<std::string_view, 2>{"on", "off"});
    command
        ->add_option(
            "--out", arguments->out,
            "folder of the results; default downwash-out/NAME-VARIANT-SEED/, with -executed behind it when the "
            "plan itself lies there")
        ->type_name("DIR");
    command->add_flag("--no-cache", arguments->no_cache,
                      "neither read nor write the cache of aero maps in $XDG_CACHE_HOME/downwash (~/.cache/downwash)");
    command->add_flag("--json", arguments->as_json, "print solution.json on standard output instead of a summary");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
