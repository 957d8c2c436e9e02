#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include "downwash/base/text.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/results/json_place.hpp"
#include "downwash/results/json_reader.hpp"
#include "downwash/results/solution_file.hpp"

namespace downwash {
namespace {

using problems::Json;
using problems::JsonReader;
using problems::Node;

constexpr std::size_t largest_file = 256UL * 1024 * 1024;  // bytes
constexpr std::size_t deepest_nesting = 32;
constexpr std::int64_t max_ticks = 1'000'000;  // nearly three hours at 100 Hz
constexpr double tolerance = 1e-9;             // of numbers that should be equal

/// The control tick at which a knot stands; nothing when it stands between two.
std::optional<std::int64_t> tick_of(double t_s, double tick_s) {
    const double ticks = std::round(t_s / tick_s);
    if (!(ticks >= 0 && ticks <= static_cast<double>(max_ticks)) ||
        std::abs(ticks * tick_s - t_s) > tolerance * std::max(t_s, tick_s)) {
        return std::nullopt;
    }
    return static_cast<std::int64_t>(ticks);
}

ReferenceKnot read_knot(JsonReader& reader, const Node& node, double tick_s) {
    ReferenceKnot knot;
    const double t_s = reader.required_number(node, "t_s");
    if (const auto tick = tick_of(t_s, tick_s)) {
        knot.tick = *tick;
    } else {
        reader.report(node, "t_s is " + to_text(t_s) + ", expected a whole number of the robot's control ticks of " +
                                to_text(tick_s) + " s, from 0 to " + std::to_string(max_ticks) + " of them");
    }
    constexpr std::array names{std::array{"x_m", "z_m", "arm_rad"}, std::array{"vx_m_s", "vz_m_s", "arm_rate_rad_s"},
                               std::array{"ax_m_s2", "az_m_s2", "arm_acceleration_rad_s2"}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        knot.point.position[axis] = reader.required_number(node, names[0][axis]);
        knot.point.velocity[axis] = reader.required_number(node, names[1][axis]);
        knot.point.acceleration[axis] = reader.required_number(node, names[2][axis]);
    }
    return knot;
}

void read_reference(JsonReader& reader, const Node& list, Plan& plan) {
    for (const Node& node : reader.groups(list)) {
        if (reader.has_enough()) {
            return;
        }
        const ReferenceKnot knot = read_knot(reader, node, plan.tick_s);
        if (plan.reference.empty() ? knot.tick != 0 : knot.tick <= plan.reference.back().tick) {
            reader.report(node, plan.reference.empty() ? "the first knot must stand at t_s 0"
                                                       : "t_s must be greater than that of the knot before");
        }
        plan.reference.push_back(knot);
    }
}

std::vector<Configuration> read_waypoints(JsonReader& reader, const Node& list) {
    std::vector<Configuration> waypoints;
    for (const Node& node : reader.groups(list)) {
        if (reader.has_enough()) {
            break;
        }
        waypoints.push_back({reader.required_number(node, "x_m"), reader.required_number(node, "z_m"),
                             reader.required_number(node, "arm_rad")});
    }
    return waypoints;
}

bool is_near(double a, double b) {
    return std::abs(a - b) <= tolerance * std::max({1.0, std::abs(a), std::abs(b)});
}

bool is_at(const Configuration& a, const Configuration& b) {
    return is_near(a.x_m, b.x_m) && is_near(a.z_m, b.z_m) && is_near(a.arm_rad, b.arm_rad);
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
    if (!is_at(start.configuration(), plan.first())) {
        const auto place = [](const Configuration& c) {
            return "x_m " + to_text(c.x_m) + ", z_m " + to_text(c.z_m) + ", arm_rad " + to_text(c.arm_rad);
        };
        reader.report(reference.at(0), "the plan begins at " + place(plan.first()) + ", but the problem starts at " +
                                           place(start.configuration()) + "; is it the plan of another problem?");
    }
}

void read_plan(JsonReader& reader, const Node& root, const Problem& problem, Solution& solution) {
    const auto node = reader.required(root, "plan");
    if (!node) {
        return;
    }
    if (!node->json->is_object()) {
        reader.report(*node, node->json->is_null() ? "the file holds no plan: the search found none"
                                                   : "expected a group with `waypoints` and `reference`");
        return;
    }
    const auto waypoints = reader.required(*node, "waypoints");
    const auto reference = reader.required(*node, "reference");
    Plan plan;
    plan.tick_s = 1 / problem.robot.controller.rate_hz;
    std::vector<Configuration> corners;
    if (waypoints && reference) {
        read_reference(reader, *reference, plan);
        corners = read_waypoints(reader, *waypoints);
    }
    if (reader.errors().empty() && plan.reference.empty()) {
        reader.report(*reference, "expected at least one knot");
    }
    if (reader.errors().empty()) {
        compare_waypoints(reader, *waypoints, corners, plan);
        check_start(reader, *reference, plan, problem.start);
    }
    solution.plan = std::move(plan);
}

void read_planning(JsonReader& reader, const Node& root, SearchRecord& record) {
    const auto planning = JsonReader::member(root, "planning");
    if (!planning || planning->json->is_null()) {
        return;
    }
    if (!planning->json->is_object()) {
        reader.report(*planning, "expected a group of keys");
        return;
    }
    record.wall_s = reader.amount(*planning, "wall_s", 0);
    record.map_wall_s = reader.amount(*planning, "map_wall_s", 0);
    record.flight_wall_s = reader.amount(*planning, "flight_wall_s", 0);
    const double first_s = reader.amount(*planning, "first_solution_wall_s", -1);
    record.first_solution_wall_s = first_s < 0 ? std::nullopt : std::optional(first_s);
    const double certified_s = reader.amount(*planning, "first_certified_wall_s", -1);
    record.first_certified_wall_s = certified_s < 0 ? std::nullopt : std::optional(certified_s);
    record.simulated_s = reader.amount(*planning, "simulated_s", 0);
    reader.read_count(*planning, "iterations", record.iterations);
    reader.read_count(*planning, "edges_simulated", record.edges_simulated);
    reader.read_count(*planning, "states_checked", record.states_checked);
    for (const Node& node : reader.groups(JsonReader::member(*planning, "improvements"))) {
        Improvement improvement{reader.amount(node, "wall_s", 0), 0, reader.amount(node, "cost", 0), {}};
        if (const double flown = reader.amount(node, "flown_cost", -1); flown >= 0) {
            improvement.flown_cost = flown;
        }
        reader.read_count(node, "iteration", improvement.iteration);
        record.improvements.push_back(improvement);
    }
    if (const auto rejected = JsonReader::member(*planning, "rejected"); rejected && rejected->json->is_object()) {
        for (const auto& [cause, value] : rejected->json->items()) {
            reader.read_count({&value, rejected->key + "." + cause}, record.rejected[cause]);
        }
    }
    // nearest_approach_m and obstruction explain a search without a plan, and there is nothing to read in its file.
}

void read_certificate(JsonReader& reader, const Node& root, std::optional<Certificate>& into) {
    const auto node = JsonReader::member(root, "certificate");
    if (!node || node->json->is_null()) {
        return;
    }
    if (!node->json->is_object()) {
        reader.report(*node, "expected a group of keys or null");
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
        return value && !value->json->is_null() ? reader.number(*value).value_or(0)
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

/// A name, or a group of weights.
void read_objective(JsonReader& reader, const Node& root, CostFunction& objective) {
    const auto node = JsonReader::member(root, "objective");
    if (!node || !node->json->is_object()) {
        Objective single{};
        reader.read_choice(root, "objective", all_objectives, single);
        objective = node ? CostFunction(single) : objective;
        return;
    }
    objective = CostFunction::of_nothing();
    for (const Objective each : all_objectives) {
        objective.weight(each) = reader.amount(*node, name_of(each).data(), 0);
    }
    if (objective == CostFunction::of_nothing()) {
        reader.report(*node, "expected a weight above 0");
    }
}

void read_head(JsonReader& reader, const Node& root, Solution& solution) {
    reader.read_choice(root, "status", std::array{Status::none, Status::approximate, Status::solved}, solution.status);
    reader.read_flag(root, "interrupted", solution.interrupted);
    reader.read_choice(root, "variant", std::array{Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada},
                       solution.variant);
    read_objective(reader, root, solution.objective);
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

[[noreturn]] void throw_at(const std::string& path, problems::TextPlace place, const std::string& message) {
    throw ProblemFileError({{path, place.line, place.column, message}});
}

std::string read_text(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string text;
    // A folder opens like a file and fails at the first byte.
    if (!stream || (stream.peek(), stream.bad())) {
        throw_at(path, {}, "cannot be read; expected a solution.json that `solve` wrote");
    }
    char block[65536];
    while (stream.read(block, sizeof block), stream.gcount() > 0) {
        text.append(block, static_cast<std::size_t>(stream.gcount()));
        if (text.size() > largest_file) {
            throw_at(path, {}, "is larger than 256 MiB and hardly the file of a plan");
        }
    }
    return text;
}

Json parse(const std::string& path, const std::string& text) {
    if (problems::json_depth(text) > deepest_nesting) {
        throw_at(path, {}, "nests deeper than the file of a plan does");
    }
    try {
        return Json::parse(text);
    } catch (const Json::parse_error& error) {
        throw_at(path, problems::place_of_byte(text, error.byte > 0 ? error.byte - 1 : 0),
                 text.empty() ? "the file is empty" : "this is not JSON, or the file was cut off here");
    } catch (const Json::exception&) {
        throw_at(path, {}, "holds a number that is too large");
    }
}

}  // namespace

Solution read_solution(const std::string& path, const Problem& problem) {
    const std::string text = read_text(path);
    const Json document = parse(path, text);
    const Node root{&document, ""};
    JsonReader reader;
    Solution solution = blank_solution(problem);
    if (!document.is_object()) {
        reader.report(root, "expected a group of keys as `solve` writes it");
    } else if (const auto schema = reader.required(root, "schema"); schema && *schema->json != solution_schema) {
        reader.report(*schema, "unsupported schema; expected " + std::string(solution_schema));
    } else if (schema) {
        read_head(reader, root, solution);
        read_planning(reader, root, solution.planning);
        read_certificate(reader, root, solution.certificate);
        read_plan(reader, root, problem, solution);
    }
    if (!reader.errors().empty()) {
        std::vector<LocatedError> errors;
        for (const KeyError& error : reader.errors()) {
            const auto place = problems::json_place(text, error.key);
            errors.push_back(
                {path, place.line, place.column, error.key.empty() ? error.message : error.key + ": " + error.message});
        }
        throw ProblemFileError(std::move(errors));
    }
    return solution;
}

}  // namespace downwash
