#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../support/test_files.hpp"
#include "downwash/controllers/space_axes.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/claims.hpp"
#include "downwash/results/space_solution_file.hpp"

// solution.json in space: read back as it was written, and what is rejected.

using namespace downwash;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

const SpaceProblem& problem() {
    static const SpaceProblem girder = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    return girder;
}

/// A plan of three knots with numbers that do not end.
SpaceSolution sample() {
    SpaceSolution solution;
    solution.algorithm = "rrt-star";
    solution.seed = 4294967295U;
    solution.threads = 3;
    SpacePlan plan;
    plan.tick_s = 1 / problem().robot.controller.rate_hz;
    plan.joints = 3;
    const std::int64_t ticks[] = {0, 333, 100003};
    for (int i = 0; i < 3; ++i) {
        SpaceKnot knot;
        knot.tick = ticks[i];
        for (int axis = 0; axis < 7; ++axis) {
            knot.point.position[axis] = axis < 3 ? problem().start.position_m[static_cast<std::size_t>(axis)] : 0;
            knot.point.position[axis] += i * std::sqrt(0.001 + axis);
            knot.point.velocity[axis] = i * (axis - 1) / 3.0;
            knot.point.acceleration[axis] = i * std::exp(-3.0 * axis);
        }
        plan.reference.push_back(knot);
    }
    solution.plan = plan;
    SpaceFlight flight;
    flight.outcome = Outcome::collision;
    flight.min_clearance_m = -0.0;
    flight.energy_j = 1000.0 / 7;
    flight.duration_s = 1.0 / 3;
    solution.execution = flight;
    solution.execution_world = {7, 12345678901234567ULL};
    return solution;
}

bool same_bytes(const SpacePlan& a, const SpacePlan& b) {
    return a.joints == b.joints && a.tick_s == b.tick_s &&
           std::equal(a.reference.begin(), a.reference.end(), b.reference.begin(), b.reference.end(),
                      [](const SpaceKnot& k, const SpaceKnot& l) {
                          return k.tick == l.tick && std::memcmp(&k.point, &l.point, sizeof(k.point)) == 0;
                      });
}

/// A reference by hand: two knots at rest, with changes to the document.
template <class Edit>
std::string edited(const Edit& edit) {
    Json document = {{"schema", "downwash/solution/v1"}, {"plan", {{"reference", Json::array()}}}};
    for (const double t_s : {0.0, 9.0}) {
        Json knot = {{"t_s", t_s}, {"x_m", -2 + t_s / 9}, {"y_m", -1.6}, {"z_m", 1.5}};
        for (const char* name : {"yaw_rad", "joint_1_rad", "joint_2_rad", "joint_3_rad"}) {
            knot[name] = 0;
        }
        document["plan"]["reference"].push_back(knot);
    }
    edit(document);
    return document.dump(1);
}

/// What reading a text says: errors, then warnings.
std::string said_of(const std::string& text) {
    const test::TestFolder folder;
    folder.write("plan.json", text);
    std::string warnings;
    const std::string errors = folder.errors_in([&] {
        static_cast<void>(read_solution((folder / "plan.json").string(), problem(), [&](const LocatedError& warning) {
            warnings += "warning " + std::to_string(warning.line) + ": " + warning.message + "\n";
        }));
    });
    return errors + "\n" + warnings;
}

template <class Edit>
std::string said_of_knots(const Edit& edit) {
    return said_of(edited([&](Json& document) { edit(document["plan"]["reference"]); }));
}

}  // namespace

TEST_CASE("A solution in space reads back as it was written, to the last bit") {
    const test::TestFolder folder;
    const SpaceSolution written = sample();
    const std::string text = solution_json(written, {"girder", "girder.yaml", "abc", {{"girder.yaml", 3, 4, "odd"}}});
    folder.write("solution.json", text);
    const std::string file = (folder / "solution.json").string();
    const SpaceSolution read = read_solution(file, problem());
    CHECK(same_bytes(*read.plan, *written.plan));
    CHECK(read.seed == written.seed);
    CHECK(read.threads == 3);
    CHECK(read.status == Status::solved);
    CHECK_FALSE(read.execution);

    const Json document = Json::parse(text);
    CHECK(document.at("plan").at("waypoints").size() == 3);
    CHECK(document.at("plan").at("reference").at(1).size() == 1 + 3 * 7);
    CHECK(document.at("warnings").at(0).at("line") == 3);
    CHECK(document.at("certificate").is_null());
    CHECK(document.at("execution").at("world") == Json{{"index", 7}, {"seed", 12345678901234567ULL}});

    const SpaceClaims claims = read_claims(file, problem());
    CHECK(same_bytes(claims.plan, *written.plan));
    CHECK(claims.has_waypoints);
    CHECK(claims.waypoints.size() == 3);
    REQUIRE(claims.flight);
    CHECK(claims.flight->outcome == "collision");
    CHECK(claims.flight->energy_j == 1000.0 / 7);
    CHECK(claims.flight->world->seed == 12345678901234567ULL);
    CHECK(claims.has_cost);
}

TEST_CASE("The order of targets in space is written and read back, and is one of the problem") {
    const test::TestFolder folder;
    SpaceProblem mission = problem();
    SpaceGoal choice;
    choice.any_of = {mission.goals.front(), mission.goals.front()};
    mission.goals = {mission.goals.front(), choice, mission.goals.front()};
    mission.in_any_order = true;
    SpaceSolution written = sample();
    written.order = VisitOrder{{{2, std::nullopt}, {1, 1}}, {{0, LeftOutReason::energy_budget, 1e5 / 3}}, true, 7, 8.5};
    const auto read_with = [&](const SpaceProblem& of, const std::string& text) {
        folder.write("solution.json", text);
        return read_solution((folder / "solution.json").string(), of);
    };
    const std::string text = solution_json(written, {"girder", "girder.yaml", "abc"});
    CHECK(read_with(mission, text).order == written.order);
    CHECK(read_claims((folder / "solution.json").string(), mission).order == written.order);
    CHECK(Json::parse(text).at("order").at("visits").at(1) == Json{{"target", 2}, {"alternative", 2}});
    CHECK_THAT(folder.errors_in([&] { return read_with(problem(), text); }),
               Contains("order: the problem has no targets in any order"));
    mission.goals.pop_back();
    CHECK_THAT(folder.errors_in([&] { return read_with(mission, text); }),
               Contains("order.visits[0].target: expected the number of a target of the problem, 1 to 2"));
    // A plan by hand shows its order, unless there is a place to return to.
    const std::string by_hand = solution_json(sample(), {"girder", "girder.yaml", "abc"});
    CHECK_FALSE(read_with(mission, by_hand).order);
    mission.return_to = mission.goals.front();
    CHECK(read_with(mission, by_hand).order == given_order(mission));
}

TEST_CASE("A flight in space costs what it takes of energy, time, length and clearance") {
    SpaceFlight flight;
    flight.energy_j = 50;
    flight.duration_s = 3;
    flight.length_m = 7;
    flight.clearance_integral = 2;
    CHECK(cost_of(flight, Objective::energy) == 50);
    CostFunction sum;
    sum.weight(Objective::time) = 10;
    CHECK(cost_of(flight, sum) == 80);
    CHECK(cost_of(flight, Objective::length) == 7);
    sum.weight(Objective::clearance) = 1;
    CHECK(cost_of(flight, sum) == 82);
}

TEST_CASE("A reference by hand needs its axes and times alone") {
    CHECK(said_of(edited([](Json&) {})) == "sound\n");
    CHECK(said_of_knots([](Json& knots) { knots[1]["vx_m_s"] = 0.0; }) == "sound\n");
}

TEST_CASE("A reference in space that cannot be flown is rejected with its place") {
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1].erase("y_m"); }), Contains("reference[1]: 'y_m' is missing"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[0].erase("joint_3_rad"); }),
               Contains("reference[0]: 'joint_3_rad' is missing"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["joint_4_rad"] = 0; }),
               Contains("'joint_4_rad' is no key here: the robot has 3 joints"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["vx_ms"] = 0; }),
               Contains("'vx_ms' is no key here") && Contains("vx_m_s"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["t_s"] = 9.003; }), Contains("control ticks of 0.01 s"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["t_s"] = 0; }), Contains("t_s must be greater"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[0]["t_s"] = 1; }), Contains("first knot must stand at t_s 0"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["t_s"] = -1; }), Contains("t_s is -1"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["x_m"] = nullptr; }), Contains("expected a number"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["x_m"] = "2"; }), Contains("expected a number"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["x_m"] = 1e300; }), Contains("expected a number between"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[0]["yaw_rad"] = 6.25; }),
               Contains("the plan begins at") && Contains("yaw_rad 6.25"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots = Json::array(); }), Contains("expected at least one knot"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots = 3; }), Contains("expected a list"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1] = Json::array(); }), Contains("expected a group of keys"));
    CHECK_THAT(said_of(edited([](Json& d) { d.erase("plan"); })), Contains("'plan' is missing"));
    CHECK_THAT(said_of(edited([](Json& d) { d["plan"] = nullptr; })), Contains("holds no plan"));
    CHECK_THAT(said_of(edited([](Json& d) { d["schema"] = "downwash/solution/v2"; })), Contains("unsupported schema"));
    CHECK_THAT(said_of(edited([](Json& d) { d["plan"]["waypoints"] = Json::array({Json::object()}); })),
               Contains("'x_m' is missing"));
    CHECK_THAT(said_of(edited([](Json& d) {
                   for (const Json& knot : d["plan"]["reference"]) {
                       Json waypoint = knot;
                       waypoint.erase("t_s");
                       d["plan"]["waypoints"].push_back(waypoint);
                   }
                   d["plan"]["waypoints"][1]["z_m"] = 1.6;
               })),
               Contains("plan.waypoints[1]: this waypoint is not where plan.reference[1] is"));
    const std::string nan = said_of(R"({"schema": "downwash/solution/v1", "plan": {"reference": [{"t_s": NaN}]}})");
    CHECK_THAT(nan, Contains("this is not JSON"));
    CHECK_THAT(said_of(""), Contains("the file is empty"));
    CHECK_THAT(said_of(std::string(100000, '[')), Contains("nests deeper"));
}

TEST_CASE("A reference that breaks limits is flown, with a warning where it does") {
    const std::string fast = said_of_knots([](Json& knots) { knots[1]["t_s"] = 1.5; });
    CHECK_THAT(fast, Catch::StartsWith("sound\n") && Contains("plan.reference[1]: the way here") &&
                         Contains("max_speed_m_s (1.25 times)") && Contains("max_acceleration_m_s2") &&
                         !Contains("max_yaw_rate"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["yaw_rad"] = 30; }),
               Contains("max_yaw_rate_deg_s") && !Contains("max_speed_m_s"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["joint_2_rad"] = 2; }), Contains("limits of the joint"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["z_m"] = 0.4; }), Contains("beyond environment.bounds"));
    CHECK_THAT(said_of_knots([](Json& knots) { knots[1]["vx_m_s"] = 0.1; }), Contains("the reference ends in motion"));
}

TEST_CASE("A plan of the plane is no plan for a problem in space, and the other way round") {
    CHECK_THAT(said_of_knots([](Json& knots) {
                   knots[0] = {{"t_s", 0}, {"x_m", -2}, {"z_m", 1.5}, {"arm_rad", 0}};
               }),
               Contains("plan.reference[0]: has arm_rad: this is a plan in a vertical plane"));
    const test::TestFolder folder;
    folder.write("solution.json", solution_json(sample(), {"girder", "girder.yaml", "abc"}));
    const Problem plane = read_problem(DOWNWASH_PROBLEMS "/open_air.yaml");
    const std::string errors =
        folder.errors_in([&] { static_cast<void>(read_solution((folder / "solution.json").string(), plane)); });
    CHECK_THAT(errors, Contains("plan.reference[0]: has y_m: this is a plan in space"));
    CHECK(std::count(errors.begin(), errors.end(), '\n') <= 1);
}
