#include "downwash/report/run_figures.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/solved_run.hpp"
#include "downwash/base/key_error.hpp"
#include "pictures.hpp"

using namespace downwash;
using Catch::Contains;
using test::record;

namespace {

FieldFigure snapshots() {
    return snapshot_figure(record(), *make_flight_model(record().problem));
}

}  // namespace

TEST_CASE("the arm of every snapshot ends where the end effector was flown") {
    const FieldFigure figure = snapshots();
    const auto flown = std::find_if(figure.lines.begin(), figure.lines.end(),
                                    [](const FigureLines& lines) { return lines.name == "flown"; });
    REQUIRE(flown != figure.lines.end());
    const auto& ee_x_m = *record().flight.find("ee_x_m");
    const auto& ee_z_m = *record().flight.find("ee_z_m");
    const auto ends_on_flight = [&](const Ring& piece) {
        for (std::size_t row = 0; row < ee_x_m.size(); ++row) {
            if (std::hypot(piece.back().x_m - ee_x_m[row], piece.back().z_m - ee_z_m[row]) < 1e-9) {
                return true;
            }
        }
        return false;
    };
    CHECK(std::count_if(flown->pieces.begin(), flown->pieces.end(), ends_on_flight) >= 6);
    CHECK(figure.points.size() == 1);
}

TEST_CASE("goals in turn have their numbers and tolerances in the picture, a single goal has no number") {
    const Goal& single = record().problem.goal;
    const auto region_of = [](const FieldFigure& figure) {
        const auto found = std::find_if(figure.lines.begin(), figure.lines.end(),
                                        [](const FigureLines& lines) { return lines.name == "tolerance of the goal"; });
        REQUIRE(found != figure.lines.end());
        return found->pieces;
    };
    const auto disc = region_of(snapshots());
    for (const PlanePoint& corner : disc.at(0)) {
        CHECK(std::hypot(corner.x_m - test::end_effector(single).x_m, corner.z_m - test::end_effector(single).z_m) ==
              Approx(test::end_effector(single).tolerance_m));
    }
    CHECK(snapshots().points.at(0).labels.empty());

    RunRecord tour = record();
    Goal first = single;
    test::end_effector(first).x_m = -1;
    test::end_effector(first).z_m = 3.5;
    test::end_effector(first).tolerance_x_m = 0.3;
    test::end_effector(first).tolerance_z_m = 0.1;
    tour.problem.goals_before = {first};
    const FieldFigure figure = snapshot_figure(tour, *make_flight_model(record().problem));
    CHECK(figure.points.at(0).labels == std::vector<std::string>{"1", "2"});
    const auto rectangle = region_of(figure);
    for (const PlanePoint& corner : rectangle.at(0)) {
        CHECK(std::abs(corner.x_m + 1) == Approx(0.3));
        CHECK(std::abs(corner.z_m - 3.5) == Approx(0.1));
    }
    // Both are drawn.
    FieldFigure unnamed = figure;
    unnamed.points.at(0).labels.clear();
    const auto lines_of = [](const FieldFigure& of) {
        const std::string texts = test::texts_of(of, 900);
        return std::count(texts.begin(), texts.end(), '\n');
    };
    CHECK(lines_of(figure) == lines_of(unnamed) + 2);
}

TEST_CASE("pictures of a run are the same bytes each time, in every format, and say what they show, with units") {
    const auto plots = time_figures(record());
    for (const PictureFormat format : {PictureFormat::svg, PictureFormat::png, PictureFormat::pdf}) {
        const PictureSettings settings{format, 600};
        CHECK(draw(snapshots(), settings) == draw(snapshots(), settings));
        CHECK(draw(plots, settings) == draw(plots, settings));
    }
    CHECK_THAT(draw(plots, {PictureFormat::pdf, 600}), Catch::StartsWith("%PDF") && !Contains("CreationDate"));
    CHECK_THAT(test::texts_of(time_figures(record()), 800),
               Contains("tracking error [m]") && Contains("angle [deg]") && Contains("rotor command [N]") &&
                   Contains("aero factor") && Contains("clearance [m]") && Contains("power [W]") &&
                   Contains("time [s]") && Contains("rotor 1, 2"));
}

TEST_CASE("the tracking error is the distance of the multirotor from its reference, in x and in z") {
    RunRecord run = record();
    const auto column = [&run](const char* name) -> std::vector<double>& {
        const auto found = std::find(run.flight.names.begin(), run.flight.names.end(), name);
        REQUIRE(found != run.flight.names.end());
        return run.flight.columns[static_cast<std::size_t>(found - run.flight.names.begin())];
    };
    const std::size_t rows = run.flight.rows();
    column("x_m").assign(rows, 1.0);
    column("z_m").assign(rows, 2.0);
    column("ref_x_m").assign(rows, 1.3);
    column("ref_z_m").assign(rows, 1.6);
    const CurveFigure figure = time_figures(run).front();
    REQUIRE(figure.curves.size() == 1);
    REQUIRE(!figure.curves[0].points.empty());
    for (const DiagramPoint& point : figure.curves[0].points) {
        REQUIRE(point.y == Approx(0.5));  // of 0.3 and 0.4
    }
}

TEST_CASE("a run without a flight has no pictures") {
    RunRecord none = record();
    for (auto& column : none.flight.columns) {
        column.clear();
    }
    CHECK_THROWS_AS(time_figures(none), InputError);
    CHECK_THROWS_AS(snapshot_figure(none, *make_flight_model(none.problem)), InputError);
}
