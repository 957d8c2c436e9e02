#include "downwash/simulation/execution.hpp"

#include <fmt/core.h>

#include <chrono>
#include <optional>
#include <vector>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/execute_arguments.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/plan_origin.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash::cli {
namespace {

/// The problem with the planner settings that the plan was made with, as far as its file tells.
Problem as_planned(Problem problem, const Solution& solution) {
    problem.planner.variant = solution.variant;
    problem.planner.algorithm = solution.algorithm;
    problem.planner.objective = solution.objective;
    problem.planner.seed = solution.seed;
    return problem;
}

/// The world that was asked for; nothing for the nominal one.
std::optional<FlownWorld> world_of(const ExecuteArguments& given, const Problem& problem) {
    const auto asked = execution_world(given, problem.uncertainty.has_value(), problem.planner.seed);
    if (!asked) {
        return std::nullopt;
    }
    return make_world(problem.robot, draw_world(*problem.uncertainty, problem.robot, asked->seed, asked->index));
}

void fly(const Problem& problem, const FlightModel& model, bool aero, const std::optional<FlownWorld>& world,
         Solution& solution) {
    const auto begin = std::chrono::steady_clock::now();
    const Problem flown = in_order(problem, solution.order);
    const FlightWorld in{world ? &*world : nullptr, 0};
    FlightState nominal = start_state(model, problem.start);
    if (world) {
        nominal.world = memory_at_start(*world, nominal.plant);
    }
    const auto start = world && is_at_rest(problem.start) ? hovering_start(model, nominal, aero, in) : nominal;
    if (!start) {
        throw std::runtime_error("in this world the vehicle cannot hover at its start: its controller diverges there");
    }
    solution.execution =
        execute(model, *start, solution.plan->reference, goals_of(flown), aero, in, {}, problem.energy_budget_j);
    solution.execution_cost = cost_of(*solution.execution, solution.objective);
    solution.flight_wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

ExitCode run(const ExecuteArguments& given) {
    if (is_space_problem_file(given.problem)) {
        return execute_in_space(given);
    }
    Interruption interruption;
    std::vector<LocatedError> warnings;
    Problem read = read_problem(
        given.problem, [&given](Problem& settings) { given.planner.apply_to(settings); },
        noting_outdated(warnings, given.is_quiet), noting(warnings, given.is_quiet));
    Solution solution = read_solution(plan_file(given.plan), read);
    require_whole_plan(given.plan);
    read = as_planned(std::move(read), solution);
    const std::optional<FlownWorld> world = world_of(given, read);
    RunFolder folder =
        claimed_folder(folder_beside_plan(given.out, default_folder(read), "-executed", plan_file(given.plan)), read,
                       given.problem, given.force);
    const bool is_other = is_of_another_problem(plan_file(given.plan), solution.certificate.has_value(), read);
    if (is_other) {
        solution.certificate.reset();
        noting(warnings, given.is_quiet)(
            {plan_file(given.plan), 1, 1,
             "this plan was made for another problem, or for another version of it: its certificate says nothing "
             "here and is left out, and the status is that of this flight"});
    }
    const auto model = make_flight_model(read);
    fly(read, *model, given.aero == "on", world, solution);
    if (is_other) {
        const bool is_solved = solution.execution->outcome == Outcome::ok && !read.uncertainty;
        solution.status = is_solved ? Status::solved : Status::approximate;
    }
    solution.execution_world = execution_world(given, read.uncertainty.has_value(), read.planner.seed);
    if (const auto warning = unseen_warning(solution, given.problem)) {
        noting(warnings, given.is_quiet)(*warning);
    }
    interruption.expect_results();
    const RunRecord record = folder.write(read, given.problem, warnings, solution, input_facts(read, model->scene()));
    write_page(folder.path(), record, given.threads);
    fmt::print("{}", given.as_json ? record.solution_text
                                   : summary_of(verdict_on_flight(*solution.execution), read, solution, folder.path()));
    if (interruption.code() != ExitCode::done) {
        return interruption.code();
    }
    return solution.execution->outcome == Outcome::ok ? ExitCode::done : ExitCode::flight_failed;
}

}  // namespace

std::optional<ExecutionWorld> execution_world(const ExecuteArguments& given, bool has_uncertainty, std::uint32_t seed) {
    if (!given.world) {
        if (given.seed) {
            throw UsageError("--seed says which worlds there are: expected --world too");
        }
        return std::nullopt;
    }
    if (!has_uncertainty) {
        throw UsageError("--world needs to know what is uncertain: " + given.problem +
                         " has no `uncertainty:`, or `uncertainty: none`; `uncertainty: {}` stands for the defaults");
    }
    return ExecutionWorld{*given.world, given.seed.value_or(seed)};
}

void add_execute(Command program, Action& action) {
    auto [command, given] = add_command<ExecuteArguments>(
        program, action, "execute",
        "Execute a plan again in closed loop; write the same files as solve, with the record of the search copied",
        run);
    add_problem(command, given.problem);
    add_plan(command, given.plan);
    given.planner.add(command, "planner.safety_margin_m");
    Option option =
        command.add_option("--aero", given.aero, "on: surface effects evaluated directly (default); off: free air");
    option.one_of({"on", "off"});
    command.add_option("--world I", given.world,
                       "world I of the problem's uncertainty to fly in; 0 is the nominal one (default)");
    command.add_option("--seed N", given.seed, "seed of the random numbers; of the worlds, default: that of the plan");
    add_out(command, "DIR", given.out, "folder for the results; default downwash-out/NAME-VARIANT-SEED-executed/");
    add_force(command, given.force);
    add_threads(command, given.threads);
    add_quiet(command, given.is_quiet);
    add_json(command, given.as_json, "solution.json");
}

}  // namespace downwash::cli
