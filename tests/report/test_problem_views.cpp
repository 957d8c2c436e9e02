#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "../support/test_problem.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/report/problem_figure.hpp"
#include "downwash/report/problem_page.hpp"
#include "pictures.hpp"

using namespace downwash;
using Catch::Contains;

namespace {

const FigureLines& lines_of(const FieldFigure& figure, const std::string& name) {
    const auto found =
        std::find_if(figure.lines.begin(), figure.lines.end(), [&](const FigureLines& l) { return l.name == name; });
    REQUIRE(found != figure.lines.end());
    return *found;
}

}  // namespace

TEST_CASE("the picture of a problem shows scene, bounds and goal, and the robot at its start with its arm") {
    const Problem problem = test::ceiling_problem();
    const auto model = make_flight_model(problem);
    const FieldFigure figure = problem_figure(problem, *model);
    CHECK(figure.obstacles.size() == problem.obstacles.size());
    CHECK(figure.extent.x_low_m < problem.bounds.x_low_m);
    CHECK(figure.extent.z_high_m > problem.bounds.z_high_m);

    const Ring bounds = lines_of(figure, "bounds of the centre of mass").pieces.at(0);
    CHECK(bounds.front().x_m == problem.bounds.x_low_m);
    CHECK(bounds.at(2).z_m == problem.bounds.z_high_m);

    // The arm hangs down from its joint, which is the centre of mass.
    const Ring arm = lines_of(figure, "robot at the start").pieces.back();
    CHECK(arm.front().x_m == Approx(-4));
    CHECK(arm.front().z_m == Approx(2));
    CHECK(arm.back().x_m == Approx(-4));
    CHECK(arm.back().z_m == Approx(2 - problem.robot.arm.length_m));

    REQUIRE(figure.points.size() == 1);
    CHECK(figure.points[0].name == "goal of the end effector");
    CHECK(figure.points[0].points.at(0).x_m == 3);
    CHECK_THAT(test::texts_of(figure), Contains("before planning") && Contains("robot at the start") &&
                                           Contains("tolerance of the goal") && Contains("ceiling"));
    const PictureSettings settings{PictureFormat::svg, 600};
    CHECK(draw(figure, settings) == draw(problem_figure(problem, *model), settings));
}

TEST_CASE("the picture of a problem names what lies within its bounds") {
    Problem problem = test::ceiling_problem();
    problem.obstacles.push_back({"tank", Sphere{0.6}, {0, 0, 2.5}});
    problem.obstacles.push_back(test::box("shelf", {3, 2, 0.6}, {-0.5, 0, 4}));
    const auto model = make_flight_model(problem);
    CHECK_THAT(test::texts_of(problem_figure(problem, *model)), Contains("tank") && Contains("shelf"));
}

TEST_CASE("goals of the vehicle are the robot there, or a line where a coordinate is free") {
    Problem problem = test::with_place(3, 4);
    const auto model = make_flight_model(problem);
    FieldFigure figure = problem_figure(problem, *model);
    REQUIRE(figure.points.size() == 1);
    CHECK(figure.points[0].name == "goal of the vehicle");
    CHECK(figure.points[0].points.at(0).z_m == 4);

    std::get<ConfigurationGoal>(problem.goal.kind).arm_rad = 0;
    figure = problem_figure(problem, *model);
    const Ring arm = lines_of(figure, "robot at a goal of the vehicle").pieces.back();
    CHECK(arm.back().x_m == Approx(3 + problem.robot.arm.length_m));

    std::get<ConfigurationGoal>(problem.goal.kind).z_m.reset();
    figure = problem_figure(problem, *model);
    CHECK(figure.points.empty());
    const Ring line = lines_of(figure, "robot at a goal of the vehicle").pieces.at(0);
    CHECK(line.front().x_m == 3);
    CHECK(line.front().z_m == problem.bounds.z_low_m);
    CHECK(line.back().z_m == problem.bounds.z_high_m);

    problem.goals_before = {test::configuration_goal(-1, 3)};
    problem.goal = test::tip_goal(3, 4.8);
    figure = problem_figure(problem, *model);
    CHECK(figure.points.at(0).labels == std::vector<std::string>{"2"});
    CHECK(figure.points.at(1).labels == std::vector<std::string>{"1"});
}

TEST_CASE("the page of a problem has its scene, its warnings and what was read, and no flight") {
    const Problem problem = test::ceiling_problem();
    const auto model = make_flight_model(problem);
    const ProblemReference reference{problem.name,
                                     "my.yaml",
                                     "",
                                     {{"my.yaml", 3, 1, "robot <is> odd; expected another"}},
                                     problem.axes(),
                                     input_facts(problem, model->scene())};
    const std::string data = problem_page_data(problem, reference, "name: ceiling\n", *model);
    CHECK(data.find('<') == std::string::npos);
    CHECK(data == problem_page_data(problem, reference, "name: ceiling\n", *model, 2));
    const auto page = nlohmann::json::parse(data);
    CHECK(page.at("schema") == "downwash/report/v1");
    CHECK(page.at("flight").is_null());
    CHECK(page.at("tree").is_null());
    CHECK(page.at("effective_yaml") == "name: ceiling\n");
    CHECK(page.at("start").at("x_m") == -4);
    CHECK(page.at("scene").at("obstacles").size() == 2);
    const auto& solution = page.at("solution");
    CHECK(solution.at("status") == "unplanned");
    CHECK_FALSE(solution.contains("planning"));
    CHECK(solution.at("plan").is_null());
    CHECK(solution.at("variant") == name_of(problem.planner.variant));
    CHECK(solution.at("problem").at("file") == "my.yaml");
    CHECK(solution.at("warnings").at(0).at("message") == "robot <is> odd; expected another");
    CHECK(solution.at("inputs").at("robot").at("mass_kg") == Approx(4.95));
}
