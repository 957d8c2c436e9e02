#include "downwash/simulation/execution.hpp"

#include <fmt/core.h>

#include <array>
#include <chrono>
#include <optional>
#include <string_view>

#include "downwash/cli/common_options.hpp"
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
    bool no_cache = false, as_json = false;

    void add_to(CLI::App& command);
    [[nodiscard]] ExitCode run() const;
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

ExitCode ExecuteArguments::run() const {
    const Interruption interruption;
    Problem read = read_problem(problem);
    Solution solution = read_solution(plan, read);
    read = as_planned(std::move(read), solution);
    const OutputFolder folder(folder_for(*this, read));
    fly(read, aero == "on", solution);
    const RunRecord record = write_results(folder, read, problem, solution);
    write_page(folder, record, nullptr, cache_folder(no_cache));
    fmt::print("{}", as_json ? record.solution_text
                             : summary_of(verdict_on_flight(*solution.execution), solution, folder.path()));
    if (interruption.code() != ExitCode::done) {
        return interruption.code();
    }
    return solution.execution->outcome == Outcome::ok ? ExitCode::done : ExitCode::flight_failed;
}

void ExecuteArguments::add_to(CLI::App& command) {
    add_problem(command, problem);
    command.add_option("--plan", plan, "solution.json that holds the plan")->type_name("FILE")->required();
    CLI::Option* option =
        command.add_option("--aero", aero, "on: surface effects evaluated directly (default); off: free air");
    require_one_of(*option, std::array<std::string_view, 2>{"on", "off"});
    command
        .add_option("--out", out,
                    "folder for the results; default downwash-out/NAME-VARIANT-SEED/, with -executed appended if the "
                    "plan itself is in that folder")
        ->type_name("DIR");
    add_no_cache(command, no_cache);
    add_json(command, as_json, "print solution.json on standard output instead of a summary");
}

}  // namespace

void add_execute(CLI::App& program, Action& action) {
    add_command<ExecuteArguments>(
        program, action, "execute",
        "Execute a plan again in closed loop; write the same files as solve, with the record of the search copied");
}

}  // namespace downwash::cli
