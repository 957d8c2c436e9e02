#include "downwash/report/run_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "downwash/base/version.hpp"
#include "downwash/report/packed_numbers.hpp"
#include "downwash/report/page_flight.hpp"
#include "downwash/report/page_scene.hpp"
#include "downwash/report/page_template.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/pose.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

Json tree_json(const NumberTable& tree, std::span<const Axis> axes) {
    if (tree.rows() == 0) {
        return {};
    }
    PackedNumbers packed;
    for (const Axis& axis : axes) {
        const std::vector<double>& column = *tree.find(axis.position);
        packed.add(std::vector<float>(column.begin(), column.end()));
    }
    std::vector<std::int32_t> parents;
    for (const double parent : *tree.find("parent")) {
        parents.push_back(std::isnan(parent) ? -1 : static_cast<std::int32_t>(parent));
    }
    packed.add(parents);
    return {{"nodes", tree.rows()}, {"data", packed.text()}};
}

/// Why the time of a search decided more than where it ended: then its command does not give the same bytes again.
/// Empty if it does.
std::string difference_by_time(const Problem& problem, const Json& solution) {
    if (problem.planner.max_iterations) {
        return {};
    }
    if (goals_of(problem).size() > 1) {
        return "several goals shared its time";
    }
    const auto unfinished = solution.value(Json::json_pointer("/planning/candidates/unfinished"), std::uint64_t{0});
    return unfinished > 0 ? "its time ended while a plan was being checked" : "";
}

/// The command that repeats a run: in its folder or, for a run that took over from a plan, where that one was made.
/// What it does not repeat stands in `note`.
struct RepeatedBy {
    std::string command, note;
};

RepeatedBy repeated_by(const Problem& problem, const Json& solution) {
    const Json::json_pointer aero("/execution/aero"), world("/execution/world"), iterations("/planning/iterations");
    const bool is_without_aero = solution.contains(aero) && solution[aero] == false;
    const bool is_in_world = solution.contains(world) && solution[world].is_object();
    if (is_without_aero || is_in_world) {
        return {command_of_execution(solution), ""};
    }
    RepeatedBy repeated{"downwash solve effective.yaml", ""};
    if (solution.contains("replanned")) {
        const Json& from = solution["replanned"];
        repeated.command = "downwash replan " + solution.at("problem").at("file").get<std::string>() + " --plan " +
                           from.at("plan").get<std::string>() + " --after " + from.at("t_s").dump();
        repeated.note = "Where the first command was given, with the same options.";
    }
    const std::string difference = difference_by_time(problem, solution);
    const bool is_split_by_time = goals_of(problem).size() > 1 && !problem.planner.max_iterations;
    if (!is_split_by_time && solution.contains(iterations) && solution[iterations].is_number_unsigned() &&
        solution[iterations] > 0) {
        repeated.command += " --max-iterations " + solution[iterations].dump();
    }
    if (!difference.empty()) {
        repeated.note += (repeated.note.empty() ? "" : " ") +
                         ("This repeats the search, but not byte for byte: " + difference + ".");
    }
    return repeated;
}

/// A goal of a problem, by its number on the way of a plan.
Goal& goal_on_way(Problem& problem, const std::optional<VisitOrder>& order, std::size_t number) {
    if (!problem.targets.empty()) {
        const Visit& visit = order->visits[number];
        Goal& target = problem.targets[visit.target];
        return visit.alternative ? target.any_of[*visit.alternative] : target;
    }
    return number < problem.goals_before.size() ? problem.goals_before[number] : problem.goal;
}

/// The problem with those places, of all from which surfaces could be touched, that the plan chose; other goals as they
/// are.
Problem with_chosen_places(const RunRecord& run, const FlightModel& model) {
    Problem problem = run.problem;
    const std::vector<Goal> goals = goals_of(in_order(problem, run.order));
    if (!run.plan || (!problem.targets.empty() && !run.order) || std::ranges::none_of(goals, may_touch)) {
        return problem;
    }
    for (const PlannedTouch& touch : touches_of(model, run.plan->reference, goals)) {
        const PlanarPose at = level_at(configuration_of(touch.base));
        goal_on_way(problem, run.order, touch.goal) = nearest_goal(goals[touch.goal], model.tick().plant, at);
    }
    return problem;
}

}  // namespace

bool has_pages() noexcept {
    return !run_page_template().empty();
}

std::string run_page_data(const RunRecord& run, const FlightModel& model, int threads) {
    const Problem& problem = run.problem;
    const Json solution = Json::parse(run.solution_text);
    const RepeatedBy repeated = repeated_by(problem, solution);
    Json page{{"schema", "downwash/report/v1"},
              {"version", version()},
              {"command", repeated.command},
              {"command_note", repeated.note},
              {"solution", solution},
              {"cost_unit", unit_of(problem.planner.objective)},
              {"effective_yaml", run.problem_text},
              {"flight", flight_json(run.flight)},
              {"tree", tree_json(run.tree, problem.axes())}};
    add_problem(page, with_chosen_places(run, model), run.order, model, threads);
    return page_data(page);
}

std::string run_page(const RunRecord& run, const FlightModel& model, int threads) {
    return filled_page(run_page_template(), run_page_data(run, model, threads));
}

}  // namespace downwash
