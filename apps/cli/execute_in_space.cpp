#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/execute_arguments.hpp"
#include "downwash/cli/in_space.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/order_rows.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/plan_origin.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/space_solution_file.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

namespace downwash::cli {
namespace {

/// The problem with the planner settings that the plan's file tells.
SpaceProblem as_planned(SpaceProblem problem, const SpaceSolution& solution) {
    problem.planner.variant = solution.variant;
    problem.planner.objective = solution.objective;
    problem.planner.seed = solution.seed;
    return problem;
}

std::string goal_rows(const SpaceFlight& flight, const std::optional<VisitOrder>& order) {
    std::string text;
    if (flight.goals.size() > 1 || (order && !order->left_out.empty())) {
        std::vector<bool> met;
        std::ranges::transform(flight.goals, std::back_inserter(met), &SpaceGoalVisit::is_met);
        text += table_row("goals", met_goals_text(order, met));
    }
    for (std::size_t i = 0; i < flight.goals.size(); ++i) {
        const SpaceGoalVisit& visit = flight.goals[i];
        if (!visit.is_met) {
            text += table_row("", fmt::format("{} missed: error {}, {:.1f} deg{}", goal_name(order, i + 1),
                                              millimetres(visit.error_m), visit.angle_rad * degrees_per_radian,
                                              visit.is_hidden ? ", the target is hidden" : ""));
        }
        if (visit.touch) {
            text += table_row(i == 0 ? "contact" : "",
                              fmt::format("{}: {:.2f} N, off by {:.2f} N at most", name_of(visit.touch->end),
                                          visit.touch->force_n, visit.touch->force_error_n));
        }
    }
    return text;
}

}  // namespace

std::string space_summary(const std::string& verdict, const SpaceSolution& solution, const std::string& before,
                          const std::string& after) {
    std::string text = verdict + "\n\n";
    text +=
        table_row("status", fmt::format("{} ({}, {}, {}, seed {})", name_of(solution.status), name_of(solution.variant),
                                        solution.algorithm, text_of(solution.objective), solution.seed)) +
        before;
    if (!solution.execution) {
        return text + after;
    }
    const SpaceFlight& flight = *solution.execution;
    if (solution.execution_world) {
        text += table_row(
            "world", fmt::format("{} of seed {}", solution.execution_world->index, solution.execution_world->seed));
    }
    text +=
        table_row("flight", fmt::format("{}, {}", name_of(flight.outcome),
                                        solution.aero ? "aerodynamics evaluated directly" : "without aerodynamics"));
    const std::string_view symbol = unit_of(solution.objective);
    const std::string unit = symbol.empty() ? "" : " " + std::string(symbol);
    const std::string planned = solution.search ? fmt::format("{:.6g}{} planned, ", solution.search->cost, unit) : "";
    text += table_row("cost", fmt::format("{}{:.6g}{} executed", planned, cost_of(flight, solution.objective), unit));
    text += table_row("duration", fmt::format("{:.2f} s", flight.duration_s));
    text += table_row("energy", fmt::format("{:.6g} J", flight.energy_j));
    text += table_row("goal error", millimetres(worst_goal_error_m(flight)));
    text += goal_rows(flight, solution.order);
    text += table_row("tracking error", millimetres(flight.max_tracking_error_m));
    text += table_row("saturation", fmt::format("{:.3f}", flight.max_saturation));
    text += table_row("min. clearance",
                      std::isfinite(flight.min_clearance_m) ? millimetres(flight.min_clearance_m) : "no obstacles");
    return text + after;
}

ExitCode execute_in_space(const ExecuteArguments& given) {
    if (given.planner.is_any()) {
        throw UsageError("--margin is a setting of searches, and a flight in space is not rejected for its margin");
    }
    Interruption interruption;
    std::vector<LocatedError> warnings;
    const auto note = noting(warnings, given.is_quiet);
    SpaceProblem problem = read_space_problem(given.problem, {}, note);
    const std::string plan = plan_file(given.plan);
    SpaceSolution solution = read_solution(plan, problem, note);
    require_whole_plan(given.plan);
    problem = as_planned(std::move(problem), solution);
    solution.execution_world = execution_world(given, problem.uncertainty.has_value(), problem.planner.seed);
    const auto usual = default_folder(problem.name, problem.planner);
    RunFolder folder =
        claimed_folder(folder_beside_plan(given.out, usual, "-executed", plan), problem, given.problem, given.force);
    const bool is_other = is_of_another_problem(plan, problem);
    if (is_other) {
        note({plan, 1, 1,
              "this plan was made for another problem, or for another version of it: the status is that of this "
              "flight"});
    }
    const SpaceProblemModel model(in_order(problem, solution.order));
    solution.aero = given.aero == "on";
    SpaceExecutionSettings settings;
    settings.aero = solution.aero;
    if (const auto& world = solution.execution_world) {
        settings.world = draw_space_world(*problem.uncertainty, problem.robot, world->seed, world->index);
    }
    solution.execution = model.execute(*solution.plan, settings);
    const bool is_good = solution.execution->outcome == Outcome::ok;
    if (is_other) {
        solution.status = is_good ? Status::solved : Status::approximate;
    }
    interruption.expect_results();
    const SpaceRunRecord record =
        folder.write(problem, given.problem, warnings, solution, input_facts(problem, model.scene()));
    write_page(folder.path(), record);
    if (given.as_json) {
        fmt::print("{}", record.solution_text);
    } else {
        const std::string verdict =
            verdict_on_outcome(solution.execution->outcome, solution.aero, "reaches the goal and hovers there.");
        fmt::print("{}{}", space_summary(verdict, solution),
                   file_rows(folder.path(), "solution.json, trajectory.csv, effective.yaml"));
    }
    if (interruption.code() != ExitCode::done) {
        return interruption.code();
    }
    return is_good ? ExitCode::done : ExitCode::flight_failed;
}

}  // namespace downwash::cli
