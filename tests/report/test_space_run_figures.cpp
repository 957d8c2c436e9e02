#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/report/space_problem_figure.hpp"
#include "pictures.hpp"
#include "space_problems.hpp"

// Pictures of runs in space.

using namespace downwash;
using Catch::Contains;

namespace {

constexpr double quarter_turn_rad = 1.5707963267948966;

/// A level vehicle that flies 4 m to +y, turns by a quarter, and raises its first joint by half a radian.
SpaceRunRecord crossing() {
    SpaceRunRecord run;
    run.problem = test::bay_problem();
    constexpr std::size_t rows = 101;
    run.flight = test::invented_rows(rows);
    const auto column = [&run](const std::string& name) -> std::vector<double>& {
        const auto found = std::ranges::find(run.flight.names, name);
        REQUIRE(found != run.flight.names.end());
        return run.flight.columns[static_cast<std::size_t>(found - run.flight.names.begin())];
    };
    for (std::size_t row = 0; row < rows; ++row) {
        const double share = static_cast<double>(row) / (rows - 1);
        column("t_s")[row] = 8 * share;
        for (const char* name : {"x_m", "ref_x_m", "ee_x_m"}) {
            column(name)[row] = -2;
        }
        for (const char* name : {"y_m", "ref_y_m", "ee_y_m"}) {
            column(name)[row] = -2 + 4 * share;
        }
        column("z_m")[row] = 2;
        column("ref_z_m")[row] = 2.1;
        column("ee_z_m")[row] = 1.7;
        column("qw")[row] = std::cos(quarter_turn_rad / 2 * share);
        column("qx")[row] = column("qy")[row] = 0;
        column("qz")[row] = std::sin(quarter_turn_rad / 2 * share);
        column("ref_yaw_rad")[row] = 4 * quarter_turn_rad + quarter_turn_rad * share;
        column("joint_1_rad")[row] = 0.5 * share;
        column("joint_2_rad")[row] = 0;
        column("clearance_m")[row] = 1;
    }
    SpacePlan plan;
    plan.tick_s = 0.01;
    plan.joints = 2;
    plan.reference.resize(2);
    plan.reference[1].tick = 800;
    for (SpaceKnot& knot : plan.reference) {
        knot.point.position[space::x] = -2;
        knot.point.position[space::z] = 2.1;
        knot.point.position[space::y] = knot.tick == 0 ? -2 : 2;
    }
    run.plan = plan;
    return run;
}

SpaceFigure figure_of(const SpaceRunRecord& run) {
    return space_run_figure(run, Scene(run.problem.obstacles));
}

const FigureLines& lines_of(const SpaceView& view, const std::string& name) {
    const auto found = std::ranges::find(view.lines, name, &FigureLines::name);
    REQUIRE(found != view.lines.end());
    return *found;
}

}  // namespace

TEST_CASE("three views of a flight show its ways and the robot as it flew") {
    const SpaceFigure figure = figure_of(crossing());
    CHECK(figure.title == "bay");
    CHECK_THAT(figure.subtitle, Contains("mp-arm-ada, every ") && Contains(" of 8 s"));
    // From above the way goes up by 4 m, from the front across.
    const Ring& above = lines_of(figure.top, "way of the end effector").pieces.at(0);
    CHECK(above.front().x_m == -2);
    CHECK(above.front().z_m == -2);
    CHECK(above.back().z_m == Approx(2));
    const Ring& front = lines_of(figure.front, "way of the end effector").pieces.at(0);
    CHECK(front.back().x_m == Approx(2));
    CHECK(front.back().z_m == 1.7);
    const Ring& planned = lines_of(figure.side, "planned way").pieces.at(0);
    CHECK(planned.front().z_m == 2.1);
    // The body is 0.4 m long and 0.3 m wide; at the end a quarter turn makes y its length.
    const std::vector<Ring>& robots = lines_of(figure.top, "flown").pieces;
    const auto size_of = [](const Ring& ring) {
        const auto [left, right] = std::ranges::minmax(ring, {}, &PlanePoint::x_m);
        const auto [low, high] = std::ranges::minmax(ring, {}, &PlanePoint::z_m);
        return std::pair(right.x_m - left.x_m, high.z_m - low.z_m);
    };
    CHECK(size_of(robots.front()).first == Approx(0.4));
    const std::size_t lines_of_one = 1 + 6 + 2;  // body, rotors, links
    REQUIRE(robots.size() % lines_of_one == 0);
    CHECK(robots.size() / lines_of_one >= 5);
    CHECK(size_of(robots[robots.size() - lines_of_one]).first == Approx(0.3));
    CHECK(size_of(robots[robots.size() - lines_of_one]).second == Approx(0.4));
    // What is shown is about the flight, not all of the bounds.
    CHECK(figure.top.extent.x_high_m < 5);
    CHECK(figure.top.extent.z_low_m < -2);
}

TEST_CASE("a picture of a flight in space has the names of obstacles unless they are left out") {
    SpaceFigure figure = figure_of(crossing());
    const std::string texts = test::texts_of(figure, 1200);
    CHECK_THAT(texts, Contains("from above") && Contains("from the front") && Contains("pier") && Contains("flown"));
    CHECK(draw(figure, {PictureFormat::svg, 800}) == draw(figure_of(crossing()), {PictureFormat::svg, 800}));
    figure.has_names = false;
    CHECK_THAT(test::texts_of(figure, 1200), !Contains("pier") && Contains("flown"));
}

TEST_CASE("plots over time of a flight in space have its error, angles and joints") {
    const std::vector<CurveFigure> figures = time_figures(crossing());
    const auto figure = [&figures](const std::string& label) -> const CurveFigure& {
        const auto found = std::ranges::find(figures, label, &CurveFigure::y_label);
        REQUIRE(found != figures.end());
        return *found;
    };
    CHECK(figures.front().title == "bay");
    CHECK(figure("tracking error [m]").curves.at(0).points.size() == 101);
    for (const DiagramPoint& point : figure("tracking error [m]").curves.at(0).points) {
        REQUIRE(point.y == Approx(0.1));
    }
    const CurveFigure angles = figure("angle [deg]");
    CHECK(angles.curves.at(0).name == "tilt");
    CHECK(angles.curves[0].points.back().y == Approx(0).margin(1e-6));
    // The reference has turned once before: the yaw is drawn beside it.
    CHECK(angles.curves.at(1).points.front().y == Approx(360));
    CHECK(angles.curves[1].points.back().y == Approx(450));
    CHECK(angles.curves.at(2).points.back().y == Approx(450));
    const CurveFigure joints = figure("joint [deg]");
    REQUIRE(joints.curves.size() == 4);
    CHECK(joints.curves[0].name == "joint 1");
    CHECK(joints.curves[0].points.back().y == Approx(0.5 * 57.29577951308232));
    CHECK(figure("rotor command [N]").curves.size() == 6);
    CHECK(figure("clearance [m]").level == test::bay_problem().planner.safety_margin_m);
    CHECK(test::texts_of(figures, 900).size() > 100);
}

TEST_CASE("a run in space without a flight has no pictures") {
    SpaceRunRecord none = crossing();
    for (auto& column : none.flight.columns) {
        column.clear();
    }
    CHECK_THROWS_AS(figure_of(none), InputError);
    CHECK_THROWS_AS(time_figures(none), InputError);
}
