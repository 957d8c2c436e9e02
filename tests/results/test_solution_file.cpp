#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "../support/same_bytes.hpp"
#include "../support/test_files.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/results/solution_file.hpp"

using namespace downwash;
using Catch::Contains;

namespace {

const Problem& problem() {
    static const Problem open_air = read_problem(DOWNWASH_PROBLEMS "/open_air.yaml");
    return open_air;
}

/// A plan of three knots with numbers that do not end.
Solution sample() {
    Solution solution;
    solution.status = Status::solved;
    solution.algorithm = "rrt-star";
    solution.seed = 4294967295U;
    solution.threads = 3;
    solution.cost = 1000.0 / 7;
    solution.planning.first_solution_wall_s = 1.0 / 3;
    solution.planning.first_certified_wall_s = 2.0 / 3;
    solution.planning.iterations = 12345678901234567ULL;
    Certificate& certificate = solution.certificate.emplace();
    certificate.is_given = true;
    certificate.worlds = 437;
    certificate.failures = 1;
    certificate.failure_probability = failure_interval(1, 437, 0.95);
    certificate.max_failure_probability = 0.01;
    certificate.confidence = 0.95;
    certificate.attempts = 2;
    certificate.causes = {{"collision", 1}};
    certificate.clearance_m = {1.0 / 30, 1.0 / 7, std::numeric_limits<double>::infinity()};
    certificate.worst = {{2000017, Outcome::collision, -0.001}, {2000003, Outcome::ok, 1.0 / 30}};
    solution.planning.improvements = {{0.1, 7, 200.0 / 7, {}}, {0.2, 9, 1000.0 / 7, 1001.0 / 7}};
    solution.planning.rejected = {{"collision", 5}, {"bounds", 0}};
    Plan plan;
    plan.tick_s = 1 / problem().robot.controller.rate_hz;
    const std::int64_t ticks[] = {0, 333, 100003};
    for (int i = 0; i < 3; ++i) {
        ReferenceKnot knot{ticks[i], at_rest(problem().start.at)};
        for (int axis = 0; axis < 3; ++axis) {
            knot.point.position[axis] += i * std::sqrt(2.0 + axis);
            knot.point.velocity[axis] = i * (axis - 1) / 3.0;
            knot.point.acceleration[axis] = i * std::exp(-30.0 * axis);
        }
        plan.reference.push_back(knot);
    }
    solution.plan = plan;
    return solution;
}

std::string sample_text() {
    return solution_json(sample(), {"open_air", "open_air.yaml", std::string(64, 'a')});
}

Solution read(const std::string& text) {
    const test::TestFolder folder;
    folder.write("solution.json", text);
    return read_solution((folder / "solution.json").string(), problem());
}

/// The first error of a file; empty when it is read.
std::string error_of(const std::string& text) {
    try {
        static_cast<void>(read(text));
    } catch (const ProblemFileError& invalid) {
        const LocatedError& error = invalid.errors().at(0);
        return std::to_string(error.line) + ":" + std::to_string(error.column) + ": " + error.message;
    }
    return "";
}

/// The sample with the first occurrence of `from` replaced.
std::string sample_with(const std::string& from, const std::string& to) {
    std::string text = sample_text();
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("A plan is read back to the last bit") {
    const Solution written = sample();
    const Solution found = read(sample_text());
    REQUIRE(found.plan);
    CHECK(test::same_bytes(*found.plan, *written.plan));
    CHECK(found.plan->tick_s == written.plan->tick_s);
    CHECK(found.cost == written.cost);
    CHECK(found.seed == written.seed);
    CHECK(found.threads == written.threads);
    CHECK(found.planning.first_solution_wall_s == written.planning.first_solution_wall_s);
    CHECK(found.planning.first_certified_wall_s == written.planning.first_certified_wall_s);
    REQUIRE(found.certificate);
    CHECK(found.certificate->is_given);
    CHECK(found.certificate->worlds == 437);
    CHECK(found.certificate->failure_probability.high == written.certificate->failure_probability.high);
    CHECK(found.certificate->causes == written.certificate->causes);
    CHECK(found.certificate->clearance_m.p01 == 1.0 / 30);
    CHECK(std::isinf(found.certificate->clearance_m.p50));
    REQUIRE(found.certificate->worst.size() == 2);
    CHECK(found.certificate->worst[0].world == 2000017);
    CHECK(found.certificate->worst[0].outcome == Outcome::collision);
    CHECK(found.certificate->worst[0].min_clearance_m == -0.001);
    CHECK(found.planning.iterations == written.planning.iterations);
    CHECK(found.planning.improvements.at(1).cost == written.planning.improvements.at(1).cost);
    CHECK(found.planning.rejected == written.planning.rejected);
    CHECK_FALSE(found.execution);
    CHECK(solution_json(found, {"open_air", "open_air.yaml", std::string(64, 'a')}) == sample_text());
}

namespace {

/// The problem of the sample with four targets, one of them with alternatives.
Problem with_targets() {
    Problem targets = problem();
    Goal either;
    either.any_of = {targets.goal, targets.goal};
    targets.targets = {targets.goal, either, targets.goal, targets.goal};
    return targets;
}

std::string text_with_order() {
    Solution solution = sample();
    VisitOrder& order = solution.order.emplace();
    order.visits = {{2, std::nullopt}, {1, 1}};
    order.left_out = {{0, LeftOutReason::energy_budget, 1e5 / 3}, {3, LeftOutReason::no_flight, std::nullopt}};
    order.is_best = true;
    order.legs = 17;
    order.cost_of_legs = 1e4 / 7;
    return solution_json(solution, {"open_air", "open_air.yaml", ""});
}

Solution read_with_targets(const std::string& text) {
    const test::TestFolder folder;
    folder.write("solution.json", text);
    return read_solution((folder / "solution.json").string(), with_targets());
}

/// What is wrong with the text after a change of what comes behind `"order"`.
std::string order_error(const std::string& from, const std::string& to) {
    std::string text = text_with_order();
    const std::size_t at = text.find(from, text.find("\"order\""));
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    try {
        static_cast<void>(read_with_targets(text));
    } catch (const ProblemFileError& invalid) {
        return invalid.errors().at(0).message;
    }
    return "";
}

}  // namespace

TEST_CASE("The order of targets is written and read back, with what is left out and why") {
    const Solution found = read_with_targets(text_with_order());
    REQUIRE(found.order);
    CHECK(found.order->visits == std::vector<Visit>{{2, std::nullopt}, {1, 1}});
    CHECK(found.order->left_out == std::vector<LeftOutTarget>{{0, LeftOutReason::energy_budget, 1e5 / 3},
                                                              {3, LeftOutReason::no_flight, std::nullopt}});
    CHECK(solution_json(found, {"open_air", "open_air.yaml", ""}) == text_with_order());
    // A plan that was written by hand visits them as they stand.
    const Solution by_hand = read_with_targets(sample_text());
    CHECK(by_hand.order == given_order(with_targets()));
    CHECK_FALSE(read(sample_text()).order);
}

TEST_CASE("An order that is none of the problem is rejected with its place") {
    CHECK_THAT(order_error("\"target\": 3", "\"target\": 5"),
               Contains("order.visits[0].target: expected the number of a target of the problem, 1 to 4"));
    CHECK_THAT(order_error("\"target\": 3", "\"target\": 2"), Contains("order.visits[1]: target 2 stands here twice"));
    CHECK_THAT(order_error("\"target\": 1", "\"target\": 0"),
               Contains("order.left_out[0].target: expected the number"));
    CHECK_THAT(order_error("\"alternative\": 2", "\"alternative\": 3"),
               Contains("order.visits[1].alternative: expected the number of an alternative of this target, 1 to 2"));
    CHECK_THAT(order_error("\"alternative\": null", "\"alternative\": 1"), Contains("this target has no alternatives"));
    CHECK_THAT(order_error("\"reason\": \"no_flight\"", "\"reason\": \"why\""),
               Contains("expected one of energy_budget or no_flight"));
    CHECK_THAT(order_error("\"left_out\"", "\"left\""), Contains("order: target 1 is missing here"));
    CHECK_THAT(error_of(text_with_order()), Contains("order: the problem has no targets in any order"));
}

TEST_CASE("Warnings are written with their places and a file is read with and without them") {
    const LocatedError warning{"robots/\"mine\".yaml", 12, 3, "rotors.positions_m puts the rotors 1 and 2 close"};
    const std::string text = solution_json(sample(), {"open_air", "open_air.yaml", "", {warning}});
    const auto warnings = nlohmann::json::parse(text).at("warnings");
    CHECK(warnings == nlohmann::json{{{"file", warning.file},
                                      {"line", 12},
                                      {"column", 3},
                                      {"message", "rotors.positions_m puts the rotors 1 and 2 close"}}});
    CHECK(read(text).plan);
    CHECK(nlohmann::json::parse(sample_text()).at("warnings") == nlohmann::json::array());
    CHECK(read(sample_with("\"warnings\": [],", "")).plan);
}

TEST_CASE("The weights of a sum are written and read back") {
    Solution solution = sample();
    solution.objective.weight(Objective::time) = 50.0 / 3;
    const std::string text = solution_json(solution, {"open_air", "open_air.yaml", ""});
    CHECK_THAT(text, Contains("\"energy\": 1.0") && !Contains("\"clearance\""));
    CHECK(read(text).objective == solution.objective);
}

TEST_CASE("The cost of the flight is written, not that of the plan") {
    Solution solution = sample();
    solution.execution.emplace();
    solution.execution->energy_j = 1234.5;
    solution.execution_cost = 2345.25;
    const std::string text = solution_json(solution, {"open_air", "open_air.yaml", ""});
    const std::string flight = text.substr(text.find("\"execution\""));
    CHECK_THAT(flight, Contains("\"energy_j\": 1234.5,") && Contains("\"cost\": 2345.25,"));
    CHECK_THAT(text.substr(0, text.size() - flight.size()), Contains("\"cost\": 142.857142857142"));
}

TEST_CASE("A touch is written with its goal, and that of the only goal beside the figures of the flight, too") {
    Solution solution = sample();
    solution.execution.emplace();
    TouchRecord touch;
    touch.is_met = true;
    touch.force_n = 4.75;
    const auto execution_with = [&](std::vector<GoalVisit> goals) {
        solution.execution->goals = std::move(goals);
        const std::string text = solution_json(solution, {"open_air", "open_air.yaml", ""});
        return nlohmann::json::parse(text).at("execution");
    };
    const nlohmann::json several = execution_with({{true, 0.01, {}}, {true, 0.02, touch}});
    CHECK_FALSE(several.contains("contact"));
    CHECK_FALSE(several.at("goals").at(0).contains("contact"));
    CHECK(several.at("goals").at(0).at("error_m") == 0.01);
    CHECK(several.at("goals").at(1).at("contact").at("force_n") == 4.75);
    const nlohmann::json only = execution_with({{true, 0.02, touch}});
    CHECK(only.at("contact") == only.at("goals").at(0).at("contact"));
    CHECK(only.at("contact").at("met") == true);
}

TEST_CASE("What is not finite is written as null, and so are cost and flight without a plan") {
    Solution solution = sample();
    solution.execution.emplace();
    solution.execution->min_clearance_m = std::numeric_limits<double>::infinity();
    solution.execution->goal_error_m = std::numeric_limits<double>::quiet_NaN();
    const std::string text = solution_json(solution, {"open_air", "\xff.yaml", ""});
    CHECK_THAT(text, Contains("\"min_clearance_m\": null") && Contains("\"goal_error_m\": null"));
    CHECK(read(text).plan);
    Solution nothing;
    nothing.algorithm = "rrt-star";
    const std::string without_plan = solution_json(nothing, {"open_air", "", ""});
    CHECK_THAT(without_plan, Contains("\"cost\": null") && Contains("\"execution\": null"));
    CHECK_THAT(error_of(without_plan), Contains("plan: the file holds no plan"));
}

TEST_CASE("A plan file that cannot be flown is an error where it is wrong") {
    const auto [from, to, expected] = GENERATE(table<std::string, std::string, std::string>({
        {"solution/v1", "solution/v2", "2:13: schema: unsupported schema"},
        {"\"schema\": \"downwash/solution/v1\",", "", "1:1: 'schema' is missing"},
        {"\"t_s\": 0.0", "\"t_s\": 0.01", "the first knot must stand at t_s 0"},
        {"\"t_s\": 3.33", "\"t_s\": 3.335", "expected a whole number of the robot's control ticks of 0.01 s"},
        {"\"t_s\": 3.33", "\"t_s\": -3.33", "expected a whole number of the robot's control ticks"},
        {"\"t_s\": 3.33", "\"t_s\": 3.330001", "expected a whole number of the robot's control ticks"},
        {"\"t_s\": 3.33", "\"t_s\": 0", "plan.reference[1]: t_s must be greater"},
        {"\"t_s\": 3.33", "\"t_s\": 2000", "plan.reference[2]: t_s must be greater"},
        {"\"t_s\": 3.33", "\"t_s\": 999999", "expected a whole number"},
        {"\"t_s\": 3.33", "\"t_s\": \"3.33\"", "plan.reference[1].t_s: expected a number, found string"},
        {"\"t_s\": 3.33", "\"t\": 3.33", "plan.reference[1]: 't_s' is missing here"},
        {"\"vx_m_s\": 0.0", "\"vx_m_s\": null", "plan.reference[0].vx_m_s: expected a number, found null"},
        {"\"vx_m_s\": 0.0", "\"vx_m_s\": 1e300", "expected a number between"},
        {"\"vx_m_s\": 0.0", "\"vx_m_s\": 1e999", "a number that is too large"},
        {"\"vx_m_s\": 0.0", "\"vx_m_s\": NaN", "this is not JSON"},
        {"\"x_m\": -6.0", "\"x_m\": -6.1", "plan.waypoints[0]: this waypoint is not where plan.reference[0] is"},
        {"\"waypoints\"", "\"way\"", "plan: 'waypoints' is missing here"},
        {"\"reference\": [", "\"reference\": [], \"old\": [", "plan.reference: expected at least one knot"},
        {"\"reference\": [", "\"reference\": [7, ", "plan.reference[0]: expected a group of keys"},
        {"\"waypoints\": [", "\"waypoints\": {}, \"old\": [", "plan.waypoints: expected a list"},
        {"\"waypoints\": [", "\"waypoints\": [], \"old\": [", "there are 0 waypoints, but 3 knots"},
        {"\"plan\": {", "\"plan\": 5, \"old\": {", "plan: expected a group"},
        {"\"status\": \"solved\"", "\"status\": \"great\"",
         "3:13: status: expected one of none, approximate or solved"},
        {"\"variant\": \"mp-arm-ada\"", "\"variant\": 5", "variant: expected one of mp-arm"},
        {"\"algorithm\": \"rrt-star\"", "\"algorithm\": \"x\"", "algorithm: expected"},
        {"\"objective\": \"energy\"", "\"objective\": \"fun\"", "objective: expected one of energy, time"},
        {"\"objective\": \"energy\"", "\"objective\": {\"time\": 0}", "objective: expected a weight above 0"},
        {"\"objective\": \"energy\"", "\"objective\": {\"time\": -1}", "objective.time: expected a number"},
        {"\"seed\": 4294967295", "\"seed\": 4294967296", "seed: expected a whole number from 0 to 4294967295"},
        {"\"interrupted\": false", "\"interrupted\": 0", "interrupted: expected true or false"},
        {"\"planning\": {", "\"planning\": 1, \"old\": {", "planning: expected a group of keys"},
        {"\"collision\": 5", "\"collision\": -5", "planning.rejected.collision: expected a whole number"},
    }));
    CAPTURE(from, to);
    CHECK_THAT(error_of(sample_with(from, to)), Contains(expected));
}

TEST_CASE("A plan of another problem is an error") {
    Solution solution = sample();
    solution.plan->reference[0].point.position[2] += 0.001;
    const std::string error = error_of(solution_json(solution, {"open_air", "", ""}));
    CHECK_THAT(error, Contains("plan.reference[0]: the plan begins at") && Contains("another problem"));
}

TEST_CASE("A file that was cut off anywhere is an error") {
    const std::string text = sample_text();
    const std::size_t whole = text.find_last_of('}');
    for (std::size_t length = 0; length <= whole; length += 7) {
        CAPTURE(length);
        CHECK_FALSE(error_of(text.substr(0, length)).empty());
    }
}

TEST_CASE("Errors of a file with a byte order mark have the places that they have without it") {
    const std::string mark = "\xEF\xBB\xBF";
    CHECK(error_of(mark + sample_text()).empty());
    for (const auto& [from, to] : {std::pair("solution/v1", "solution/v2"), std::pair("\"t_s\": 0.0", "\"t_s\": 0.01"),
                                   std::pair("\"seed\":", "\"seed\"")}) {
        const std::string text = sample_with(from, to);
        CHECK_FALSE(error_of(text).empty());
        CHECK(error_of(mark + text) == error_of(text));
    }
}

TEST_CASE("The place of an error is looked for no farther than to the end of the document") {
    // The parser reads the escape; the search for the place does not, and comes to the end.
    const std::string text = sample_with("\"seed\": ", "\"\\u0073eed\": -");
    CHECK_THAT(error_of(text), Contains("seed: expected a whole number"));
    CHECK(error_of(text + std::string(1, '\0') + ",]}") == error_of(text));
}

TEST_CASE("Megabytes of brackets do not overflow the stack") {
    for (const std::string bracket : {"[", "{\"a\":", "[{\"a\":"}) {
        std::string text;
        for (int i = 0; i < 2'000'000; ++i) {
            text += bracket;
        }
        CHECK_THAT(error_of(text), Contains("nests deeper"));
    }
}

TEST_CASE("A plan file that is larger than any of ours is an error that says how large it may be") {
    const std::string text = sample_text();
    const std::string blanks((16U << 20U) - text.size(), ' ');
    CHECK(error_of(text + blanks).empty());
    CHECK_THAT(error_of(text + blanks + " "), Contains("is larger than 16 MiB, more than any plan of `solve` takes"));
}

TEST_CASE("Random bytes in a plan file never do worse than an error") {
    const std::string text = sample_text();
    std::uint32_t random = 12345;
    for (int i = 0; i < 2000; ++i) {
        std::string broken = text;
        for (int k = 0; k < 3; ++k) {
            random = random * 1664525U + 1013904223U;
            broken[(random >> 8U) % broken.size()] = "{}[],:\"0-9e\\tn\xff "[random % 16];
        }
        CHECK_NOTHROW(error_of(broken));
    }
}
