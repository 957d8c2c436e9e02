#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "downwash/base/text.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/results/order_reader.hpp"
#include "downwash/results/plan_reader.hpp"
#include "downwash/results/solution_document.hpp"
#include "downwash/results/solution_file.hpp"

namespace downwash {
namespace {

using problems::JsonReader;
using problems::Node;

constexpr double tolerance = 1e-9;  // of numbers that should be equal

bool is_near(double a, double b) {
    return std::abs(a - b) <= tolerance * std::max({1.0, std::abs(a), std::abs(b)});
}

bool is_at(const Configuration& a, const Configuration& b) {
    return std::ranges::equal(a.coordinate, b.coordinate, is_near);
}

/// Waypoints and reference must tell the same story.
void compare_waypoints(JsonReader& reader, const Node& list, const std::vector<Configuration>& waypoints,
                       const Plan& plan) {
    if (waypoints.size() != plan.reference.size()) {
        reader.report(list, "there are " + std::to_string(waypoints.size()) + " waypoints, but " +
                                std::to_string(plan.reference.size()) + " knots of the reference");
        return;
    }
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
        if (!is_at(waypoints[i], configuration_of(plan.reference[i].point))) {
            reader.report(list.at(i), "this waypoint is not where plan.reference[" + std::to_string(i) + "] is");
        }
    }
}

void check_start(JsonReader& reader, const Node& reference, const Plan& plan, const Start& start) {
    const Configuration begin = start.reference ? configuration_of(*start.reference) : start.at;
    if (!is_at(begin, plan.first())) {
        const auto place = [&plan](const Configuration& c) {
            std::string text;
            for (std::size_t i = 0; i < plan.axes.size(); ++i) {
                text += (i > 0 ? ", " : "") + std::string(plan.axes[i].position) + ' ' + to_text(c[i]);
            }
            return text;
        };
        reader.report(reference.at(0), "the plan begins at " + place(plan.first()) + ", but the problem starts at " +
                                           place(begin) + "; is it the plan of another problem?");
    }
}

void read_plan(JsonReader& reader, const Node& root, const Problem& problem, Solution& solution) {
    problems::PlanText text = problems::read_plan(reader, root, problem);
    if (reader.errors().empty()) {
        compare_waypoints(reader, *text.waypoints_node, text.waypoints, text.plan);
        check_start(reader, *text.reference_node, text.plan, problem.start);
    }
    solution.plan = std::move(text.plan);
}

void read_planning(JsonReader& reader, const Node& root, Solution& solution) {
    const auto planning = reader.optional_group(root, "planning");
    if (!planning) {
        return;
    }
    SearchRecord& record = solution.planning;
    record.wall_s = reader.amount(*planning, "wall_s", 0);
    record.map_wall_s = reader.amount(*planning, "map_wall_s", 0);
    solution.flight_wall_s = reader.amount(*planning, "flight_wall_s", 0);
    record.first_solution_wall_s = reader.optional_amount(*planning, "first_solution_wall_s");
    record.first_certified_wall_s = reader.optional_amount(*planning, "first_certified_wall_s");
    record.simulated_s = reader.amount(*planning, "simulated_s", 0);
    reader.read_count(*planning, "iterations", record.iterations);
    reader.read_count(*planning, "edges_simulated", record.edges_simulated);
    reader.read_count(*planning, "states_checked", record.states_checked);
    for (const Node& node : reader.groups(JsonReader::member(*planning, "improvements"))) {
        Improvement improvement{reader.amount(node, "wall_s", 0), 0, reader.amount(node, "cost", 0),
                                reader.optional_amount(node, "flown_cost")};
        reader.read_count(node, "iteration", improvement.iteration);
        record.improvements.push_back(improvement);
    }
    if (const auto rejected = JsonReader::member(*planning, "rejected"); rejected && rejected->json->is_object()) {
        for (const auto& [cause, value] : rejected->json->items()) {
            reader.read_count({&value, rejected->key + "." + cause}, record.rejected[cause]);
        }
    }
    if (const auto stopped_by = JsonReader::member(*planning, "stopped_by");
        stopped_by && stopped_by->json->is_object()) {
        for (const auto& [obstacle, value] : stopped_by->json->items()) {
            reader.read_count({&value, stopped_by->key + "." + obstacle}, record.stopped_by[obstacle]);
        }
    }
    if (const auto candidates = JsonReader::member(*planning, "candidates");
        candidates && candidates->json->is_object()) {
        reader.read_count(*candidates, "checked", record.candidates.checked);
        reader.read_count(*candidates, "failed_execution", record.candidates.failed_execution);
        reader.read_count(*candidates, "failed_certificate", record.candidates.failed_certificate);
        reader.read_count(*candidates, "worse_stops", record.candidates.worse_stops);
        reader.read_count(*candidates, "unfinished", record.candidates.unfinished);
    }
    // nearest_approach_m and obstruction explain a search without a plan, and there is nothing to read in its file.
}

void read_certificate(JsonReader& reader, const Node& root, std::optional<Certificate>& into) {
    const auto node = reader.optional_group(root, "certificate");
    if (!node) {
        return;
    }
    Certificate& certificate = into.emplace();
    reader.read_flag(*node, "given", certificate.is_given);
    reader.read_count(*node, "worlds", certificate.worlds);
    reader.read_count(*node, "failures", certificate.failures);
    reader.read_count(*node, "attempts", certificate.attempts);
    certificate.max_failure_probability = reader.amount(*node, "max_failure_probability", 0);
    certificate.confidence = reader.amount(*node, "confidence", 0);
    if (const auto share = JsonReader::member(*node, "failure_probability"); share && share->json->is_object()) {
        certificate.failure_probability = {reader.amount(*share, "estimate", 0), reader.amount(*share, "low", 0),
                                           reader.amount(*share, "high", 1)};
    }
    if (const auto causes = JsonReader::member(*node, "causes"); causes && causes->json->is_object()) {
        for (const auto& [cause, value] : causes->json->items()) {
            reader.read_count({&value, causes->key + "." + cause}, certificate.causes[cause]);
        }
    }
    // What flew far from every obstacle has no clearance: null.
    const auto clearance = [&](const Node& group, const char* name) {
        const auto value = JsonReader::member(group, name);
        return value && !value->json->is_null() ? reader.figure(*value).value_or(0)
                                                : std::numeric_limits<double>::infinity();
    };
    if (const auto all = JsonReader::member(*node, "clearance_m"); all && all->json->is_object()) {
        certificate.clearance_m = {clearance(*all, "p01"), clearance(*all, "p10"), clearance(*all, "p50")};
    }
    for (const Node& each : reader.groups(JsonReader::member(*node, "worst"))) {
        WorldSample& sample = certificate.worst.emplace_back();
        reader.read_count(each, "world", sample.world);
        reader.read_choice(each, "outcome", all_outcomes, sample.outcome);
        sample.min_clearance_m = clearance(each, "min_clearance_m");
    }
}

void read_algorithm(JsonReader& reader, const Node& root, Solution& solution) {
    const auto node = JsonReader::member(root, "algorithm");
    if (!node) {
        return;
    }
    std::vector<std::string_view> names;
    for (const AlgorithmInfo& known : algorithms()) {
        names.push_back(known.name);
        if (*node->json == known.name) {
            solution.algorithm = known.name;
            return;
        }
    }
    reader.report(*node, "expected " + std::string(names.size() > 1 ? "one of " : "") + joined_names(names));
}

void read_head(JsonReader& reader, const Node& root, Solution& solution) {
    reader.read_choice(root, "status", std::array{Status::none, Status::approximate, Status::solved}, solution.status);
    reader.read_flag(root, "interrupted", solution.interrupted);
    reader.read_choice(root, "variant", all_variants, solution.variant);
    problems::read_objective(reader, root, solution.objective);
    read_algorithm(reader, root, solution);
    reader.read_count(root, "seed", solution.seed);
    reader.read_count(root, "threads", solution.threads);
    solution.cost = reader.amount(root, "cost", 0);
}

/// A solution with nothing in it but what the problem asks for.
Solution blank_solution(const Problem& problem) {
    Solution solution;
    solution.status = Status::solved;
    solution.variant = problem.planner.variant;
    solution.algorithm = problem.planner.algorithm;
    solution.objective = problem.planner.objective;
    solution.seed = problem.planner.seed;
    return solution;
}

}  // namespace

Solution read_solution(const std::string& path, const Problem& problem) {
    Solution solution = blank_solution(problem);
    problems::read_document(path, [&](JsonReader& reader, const Node& root) {
        read_head(reader, root, solution);
        read_planning(reader, root, solution);
        read_certificate(reader, root, solution.certificate);
        read_plan(reader, root, problem, solution);
        const Plan& plan = *solution.plan;
        problems::read_stops(reader, root, plan.tick_s, solution.safe_stops,
                             [&](const Node& rest) { return problems::read_configuration(reader, rest, plan.axes); });
        solution.order = problems::read_order(reader, root, problem);
    });
    return solution;
}

}  // namespace downwash
