#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "downwash/report/space_problem_figure.hpp"
#include "pictures.hpp"
#include "space_problems.hpp"

using namespace downwash;
using Catch::Contains;

namespace {

SpaceFigure figure_of(const SpaceProblem& problem) {
    return space_problem_figure(problem, Scene(problem.obstacles));
}

const FigureLines& lines_of(const SpaceView& view, const std::string& name) {
    const auto found =
        std::find_if(view.lines.begin(), view.lines.end(), [&](const FigureLines& l) { return l.name == name; });
    REQUIRE(found != view.lines.end());
    return *found;
}

/// Least and greatest coordinates of lines.
Bounds box_of(const std::vector<Ring>& rings) {
    Bounds box{1e9, -1e9, 1e9, -1e9};
    for (const Ring& ring : rings) {
        for (const PlanePoint& p : ring) {
            box = {std::min(box.x_low_m, p.x_m), std::max(box.x_high_m, p.x_m), std::min(box.z_low_m, p.z_m),
                   std::max(box.z_high_m, p.z_m)};
        }
    }
    return box;
}

void check_box(const Bounds& box, double x_low, double x_high, double z_low, double z_high) {
    CHECK(box.x_low_m == Approx(x_low).margin(1e-9));
    CHECK(box.x_high_m == Approx(x_high).margin(1e-9));
    CHECK(box.z_low_m == Approx(z_low).margin(1e-9));
    CHECK(box.z_high_m == Approx(z_high).margin(1e-9));
}

}  // namespace

TEST_CASE("three views show every obstacle where it is, from above, from the side and from the front") {
    const SpaceFigure figure = figure_of(test::bay_problem());
    CHECK(figure.title == "bay");
    for (const SpaceView* view : {&figure.top, &figure.side, &figure.front}) {
        REQUIRE(view->obstacles.size() == 2);
        CHECK(view->obstacles[0].name == "pier");
    }
    // The girder is 8 m long in x, 0.4 m in y and 1.2 m high; its middle is at (0, 1.5, 4.2).
    check_box(box_of(figure.top.obstacles[1].rings), -4, 4, 1.3, 1.7);
    check_box(box_of(figure.side.obstacles[1].rings), -4, 4, 3.6, 4.8);
    check_box(box_of(figure.front.obstacles[1].rings), 1.3, 1.7, 3.6, 4.8);
    // A pier is round from above alone.
    check_box(box_of(figure.top.obstacles[0].rings), 2.5, 3.5, 1, 2);
    CHECK(std::abs(test::area_of(figure.top.obstacles[0].rings.at(0))) == Approx(0.785).margin(0.003));
    check_box(box_of(figure.front.obstacles[0].rings), 1, 2, 0, 6);
}

TEST_CASE("obstacles turn in a view as they are turned in the world, and parts of a mesh stand apart") {
    SpaceProblem problem = test::bay_problem();
    const double eighth = 0.7853981633974483;
    // Two triangles apart, in the plane z = 0 of the mesh, turned up about x.
    auto surface = std::make_shared<TriangleMesh>();
    surface->vertices_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 0}, {4, 0, 0}, {3, 1, 0}};
    surface->triangles = {{0, 1, 2}, {3, 4, 5}};
    Mesh mesh;
    mesh.surface = surface;
    problem.obstacles = {{"box", Box{{2, 1, 1}}, {1, 2, 3}, {0, 0, eighth}},
                         {"mesh", mesh, {-1, 0, 2}, {2 * eighth, 0, 0}}};
    const SpaceFigure figure = figure_of(problem);
    const double half = 1.5 * std::sqrt(0.5);
    check_box(box_of(figure.top.obstacles[0].rings), 1 - half, 1 + half, 2 - half, 2 + half);
    check_box(box_of(figure.front.obstacles[0].rings), 2 - half, 2 + half, 2.5, 3.5);
    REQUIRE(figure.side.obstacles[1].rings.size() == 2);
    check_box(box_of(figure.side.obstacles[1].rings), -1, 3, 2, 3);
}

TEST_CASE("the robot stands at its start, turned as it is there, with its arm") {
    SpaceProblem problem = test::bay_problem();
    problem.start.yaw_rad = 1.5707963267948966;
    SpaceFigure figure = figure_of(problem);
    // Its body is 0.4 m long and 0.3 m wide; a quarter turn makes y its length.
    const Ring body = lines_of(figure.top, "robot at the start").pieces.at(0);
    check_box(box_of({body}), -3.15, -2.85, -2.2, -1.8);
    // The end effector: the joints' places and the last way, from x to y by the turn.
    const PlanePoint tip = figure.top.points.at(0).points.at(0);
    CHECK(figure.top.points.at(0).labels.at(0) == "start");
    CHECK(tip.x_m == Approx(-3 - 0.01));
    CHECK(tip.z_m == Approx(-2 + 0.02 + 0.02 + 0.03));
    CHECK(figure.side.points.at(0).points.at(0).z_m == Approx(1.5 - 0.06 - 0.14 - 0.12));

    // The first joint turns about y: a quarter turn brings what hangs to -x of the body.
    problem.start.yaw_rad = 0;
    problem.start.joints_rad = {1.5707963267948966, 0};
    figure = figure_of(problem);
    const PlanePoint raised = figure.side.points.at(0).points.at(0);
    CHECK(raised.x_m == Approx(-3 + 0.02 - 0.14 - 0.12));
    CHECK(raised.z_m == Approx(1.5 - 0.06 - 0.02 - 0.03));

    // Rolled by a quarter turn to the left: what hangs below is to the right, -y.
    problem.start.joints_rad.clear();
    problem.start.attitude = std::array<double, 4>{std::sqrt(0.5), -std::sqrt(0.5), 0, 0};
    figure = figure_of(problem);
    const PlanePoint rolled = figure.front.points.at(0).points.at(0);
    CHECK(rolled.x_m == Approx(-2 - 0.32));
    CHECK(rolled.z_m == Approx(1.5 - 0.01));
}

TEST_CASE("goals in space have their point, tolerance and direction in every view") {
    SpaceProblem problem = test::bay_problem();
    SpaceFigure figure = figure_of(problem);
    CHECK(figure.front.points.at(1).points.at(0).x_m == 0.9);
    CHECK(figure.front.points.at(1).points.at(0).z_m == 3);
    check_box(box_of(lines_of(figure.top, "tolerance of the goal").pieces), 0.9, 1.1, 0.8, 1);
    // It points down: seen from above there is no arrow.
    const Ring arrow = lines_of(figure.side, "direction of the tool at the goal").pieces.at(0);
    CHECK(arrow.front().z_m > arrow.back().z_m);
    CHECK(std::none_of(figure.top.lines.begin(), figure.top.lines.end(),
                       [](const FigureLines& lines) { return lines.has_arrows; }));
    SpaceCameraGoal camera;
    camera.target_m = {0, 1.5, 3.6};
    camera.nearest_m = 0.5;
    camera.farthest_m = 1.5;
    problem.goals.push_back(SpaceGoal{camera});
    figure = figure_of(problem);
    CHECK(figure.top.points.at(1).labels == std::vector<std::string>{"goal 1", "goal 2"});
    check_box(box_of(lines_of(figure.side, "range of the camera").pieces), -1.5, 1.5, 2.1, 5.1);
}

TEST_CASE("the three views are one picture with the names of obstacles, equal ones have equal bytes") {
    const SpaceProblem problem = test::bay_problem();
    const SpaceFigure figure = figure_of(problem);
    const std::string texts = test::texts_of(figure, 1200);
    CHECK_THAT(texts, Contains("from above") && Contains("from the side") && Contains("from the front"));
    CHECK_THAT(texts, Contains("pier") && Contains("girder") && Contains("goal") && Contains("start"));
    CHECK_THAT(texts, Contains("robot at the start") && Contains("bounds of the centre of mass"));
    const PictureSettings settings{PictureFormat::svg, 800};
    CHECK(draw(figure, settings) == draw(figure_of(problem), settings));
    CHECK(test::png_size(draw(figure, {PictureFormat::png, 640}))[0] == 640);
}

TEST_CASE("no name of a problem in space runs a command or breaks a picture") {
    const test::WorkingFolder here;
    SpaceProblem problem = test::bay_problem();
    for (const std::string& text : test::hostile_texts()) {
        problem.obstacles[0].name = text;
        CHECK_THAT(test::texts_of(figure_of(problem), 900), Contains("girder"));
    }
    CHECK(here.is_empty());
}

TEST_CASE("long and flat bounds leave room for all three views") {
    SpaceProblem problem = test::bay_problem();
    problem.bounds = {{-40, -1, 0.5}, {40, 3, 2}};
    problem.start.position_m = {-30, 0, 1};
    const SpaceFigure figure = figure_of(problem);
    const auto width = [](const SpaceView& view) { return view.extent.x_high_m - view.extent.x_low_m; };
    CHECK(width(figure.front) > 0.2 * width(figure.top));
    CHECK(figure.top.extent.x_low_m < -40);
    CHECK_THAT(test::texts_of(figure, 400), Contains("from the front"));
}
