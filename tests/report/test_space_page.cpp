#include "downwash/report/space_page.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "downwash/report/run_page.hpp"
#include "packed_flights.hpp"
#include "space_problems.hpp"

using namespace downwash;
using Catch::Contains;
using nlohmann::json;

namespace {

json data_of(const SpaceProblem& problem, const SpaceRun& run = {}) {
    return json::parse(space_page_data(problem, run));
}

}  // namespace

TEST_CASE("the page of a problem in space has its scene, robot, start and goal in world coordinates, and no flight") {
    const SpaceProblem problem = test::bay_problem();
    REQUIRE(space_problem_errors(problem).empty());
    SpaceRun run;
    run.problem_text = "name: bay\n";
    run.warnings = R"([{"file": "bay.yaml", "line": 3, "column": 1, "message": "robot <is> odd"}])";
    const json page = data_of(problem, run);
    CHECK(page.at("schema") == "downwash/space-report/v1");
    CHECK(page.at("name") == "bay");
    CHECK(page.at("flight").is_null());
    CHECK(page.at("solution").is_null());
    CHECK(page.at("findings").is_null());
    CHECK(page.at("warnings").at(0).at("message") == "robot <is> odd");
    CHECK(page.at("effective_yaml") == "name: bay\n");

    const json& scene = page.at("scene");
    CHECK(scene.at("bounds").at("low_m") == json({-5., -4., 0.5}));
    const json& pier = scene.at("obstacles").at(0);
    CHECK(pier.at("kind") == "cylinder");
    CHECK(pier.at("low_m") == json({2.5, 1., 0.}));
    CHECK(pier.at("solid").at("cylinder").at("axis") == json({0., 0., 1.}));
    CHECK(scene.at("obstacles").at(1).at("solid").at("box").at("center_m") == json({0., 1.5, 4.2}));

    const json& robot = page.at("robot");
    CHECK(robot.at("rotors").size() == 6);
    CHECK(robot.at("rotors").at(1).at("spin") == -1);
    CHECK(robot.at("rotors").at(0).at("max_thrust_n") == 12);
    CHECK(robot.at("links").at(0).at("limits_rad") == json({-1., 1.5}));
    CHECK(robot.at("links").at(1).at("limits_rad").is_null());
    CHECK(robot.at("links").at(1).at("axis") == json({1., 0., 0.}));
    CHECK(robot.at("links").at(1).at("bodies").at(0).at("capsule").at("to_m") == json({0.03, 0., -0.12}));
    CHECK(robot.at("facts").at("mass_kg") == Approx(problem.robot.mass_kg()));

    const json& attitude = page.at("start").at("attitude");
    CHECK(attitude.at(0).get<double>() == Approx(std::cos(problem.start.yaw_rad / 2)));
    CHECK(attitude.at(3).get<double>() == Approx(std::sin(problem.start.yaw_rad / 2)));
    CHECK(page.at("start").at("joints_rad") == json({0., 0.}));

    REQUIRE(page.at("goals").size() == 1);
    const json& goal = page.at("goals").at(0);
    CHECK(goal.at("name") == "goal");
    CHECK(goal.at("kind") == "end_effector");
    CHECK(goal.at("position_m") == json({1., 0.9, 3.}));
    CHECK(goal.at("direction") == json({0., 0., -2.}));
    CHECK(page.at("goal_order") == "single");
    CHECK(page.at("limits").at("max_tilt_rad") ==
          Approx(std::get<SpaceInversion>(problem.robot.controller.law).max_tilt_rad));
}

TEST_CASE("a start's attitude of any length stands on the page with length 1") {
    SpaceProblem problem = test::bay_problem();
    problem.start.attitude = std::array<double, 4>{2, 0, 2, 0};
    const json attitude = data_of(problem).at("start").at("attitude");
    CHECK(attitude.at(0).get<double>() == Approx(std::sqrt(0.5)));
    CHECK(attitude.at(2).get<double>() == Approx(std::sqrt(0.5)));
}

TEST_CASE("every kind of goal in space stands on the page, alternatives by their numbers") {
    SpaceProblem problem = test::bay_problem();
    SpacePoseGoal pose;
    pose.position_m = {1, -1, 2};
    pose.rpy_rad = {0.1, 0.2, 0.3};
    SpaceCameraGoal camera;
    camera.target_m = {0, 1.5, 3.6};
    camera.nearest_m = 0.5;
    camera.farthest_m = 1.5;
    SpaceConfigurationGoal configuration;
    configuration.x_m = 2;
    configuration.yaw_rad = 1;
    SpaceContactGoal contact;
    contact.obstacle = "pier";
    SpaceGoal choice;
    choice.any_of = {SpaceGoal{pose}, SpaceGoal{camera}};
    choice.hold_s = 2;
    problem.goals = {SpaceGoal{configuration}, choice, SpaceGoal{contact}};
    problem.in_any_order = true;
    const json page = data_of(problem), goals = page.at("goals");
    std::vector<std::string> names, kinds;
    for (const json& goal : goals) {
        names.push_back(goal.at("name"));
        kinds.push_back(goal.at("kind"));
    }
    CHECK(names ==
          std::vector<std::string>{"target 1", "target 2, alternative 1", "target 2, alternative 2", "target 3"});
    CHECK(kinds == std::vector<std::string>{"configuration", "pose", "camera", "contact"});
    CHECK(page.at("goal_order") == "any_order");
    CHECK(goals.at(0).at("position_m").at(0) == 2);
    CHECK(goals.at(0).at("position_m").at(1).is_null());
    CHECK(goals.at(0).at("joints_rad").is_null());
    CHECK(goals.at(1).at("number") == 2);
    CHECK(goals.at(1).at("hold_s") == 2);
    CHECK(goals.at(1).at("rpy_rad") == json({0.1, 0.2, 0.3}));
    CHECK(goals.at(2).at("distance_m") == json({0.5, 1.5}));
    CHECK(goals.at(2).at("direction").is_null());
    CHECK(goals.at(3).at("position_m").is_null());
    CHECK(goals.at(3).at("obstacle") == "pier");
}

TEST_CASE("a page in space carries the flight to the last bit, with its outcome and what a judge found") {
    const SpaceProblem problem = test::bay_problem();
    SpaceRun run;
    run.flight = test::invented_rows(57);
    run.flight.columns[3][7] = std::nextafter(1., 2);
    run.solution_text = R"({"execution": {"outcome": "ok"}})";
    run.findings = R"({"outcome": "ok", "runs": 20, "failures": 1})";
    run.command = "downwash execute bay.yaml --plan solution.json";
    const json page = data_of(problem, run);
    CHECK(page.at("flight").at("rows") == 57);
    CHECK(page.at("flight").at("columns") == json(run.flight.names));
    const auto columns = test::columns_of(page.at("flight"));
    REQUIRE(columns.size() == run.flight.columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
        CAPTURE(run.flight.names[i]);
        CHECK(columns[i] == run.flight.columns[i]);
    }
    CHECK(page.at("solution").at("execution").at("outcome") == "ok");
    CHECK(page.at("findings").at("runs") == 20);
    CHECK(page.at("command") == run.command);
    CHECK(space_page_data(problem, run) == space_page_data(problem, run));
}

TEST_CASE("a clearance without obstacles is no number on the page in space either") {
    SpaceRun run;
    run.flight = test::invented_rows(3);
    const auto at =
        std::find(run.flight.names.begin(), run.flight.names.end(), "clearance_m") - run.flight.names.begin();
    auto& clearance = run.flight.columns[static_cast<std::size_t>(at)];
    std::fill(clearance.begin(), clearance.end(), std::numeric_limits<double>::quiet_NaN());
    const auto shown = test::columns_of(data_of(test::bay_problem(), run).at("flight"))[static_cast<std::size_t>(at)];
    CHECK(std::all_of(shown.begin(), shown.end(), [](double value) { return std::isnan(value); }));
}

TEST_CASE("no text of a problem in space ends the script element that carries it") {
    SpaceProblem problem = test::bay_problem();
    problem.description = "</script><script>alert(1)</script> <!-- & \xE2\x80\xA8";
    problem.obstacles[0].name = "</script>\"'";
    problem.robot.name = "<img src=x onerror=alert(1)>";
    SpaceRun run;
    run.command = "rm -rf <b>";
    run.problem_text = "a: <!-- b -->";
    const std::string text = space_page_data(problem, run);
    CHECK(text.find_first_of("<>&") == std::string::npos);
    CHECK(std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }));
    const json page = json::parse(text);
    CHECK(page.at("description") == problem.description);
    CHECK(page.at("scene").at("obstacles").at(0).at("name") == problem.obstacles[0].name);
    if (has_pages()) {
        const std::string whole = space_page(problem, run);
        CHECK(whole.find(text) != std::string::npos);
        CHECK_THAT(whole, Contains("Content-Security-Policy") && !Contains("{\"downwash\":\"nothing\"}"));
    }
}
