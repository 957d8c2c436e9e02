#include "downwash/report/label_placement.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "../support/random.hpp"
#include "../support/repetitions.hpp"
#include "../support/solved_run.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/report/obstacle_drawing.hpp"
#include "downwash/report/run_figures.hpp"

using namespace downwash;

namespace {

constexpr double height_m = 18;  // one pixel is one metre here

LabelGround plain_ground() {
    return {{0, 1000, 0, 600}, 1, height_m, {}, [](const PlanePoint& /*at*/) { return 0; }};
}

Ring rectangle(double left, double right, double bottom, double top) {
    return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

NamedShape solid(double name_width_m, const Ring& ring) {
    Ring edge = ring;
    edge.push_back(ring.front());
    return {name_width_m, {ring}, {edge}};
}

bool meet(const Bounds& a, const Bounds& b) {
    return a.x_low_m < b.x_high_m && b.x_low_m < a.x_high_m && a.z_low_m < b.z_high_m && b.z_low_m < a.z_high_m;
}

bool holds(const Bounds& box, const PlanePoint& p) {
    return p.x_m > box.x_low_m && p.x_m < box.x_high_m && p.z_m > box.z_low_m && p.z_m < box.z_high_m;
}

/// Calls visit(point) along a line, at most `step_m` apart.
template <class Visit>
void walk(const Ring& line, double step_m, const Visit& visit) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const PlanePoint &a = line[i], &b = line[i + 1];
        const double steps = std::ceil(std::hypot(b.x_m - a.x_m, b.z_m - a.z_m) / step_m);
        for (double k = 0; k <= steps && steps > 0; ++k) {
            visit(PlanePoint{a.x_m + k / steps * (b.x_m - a.x_m), a.z_m + k / steps * (b.z_m - a.z_m)});
        }
    }
}

}  // namespace

TEST_CASE("a name goes into its shape where it fits, else beside it") {
    const auto labels = place_labels(
        {solid(80, rectangle(100, 300, 100, 200)), solid(80, rectangle(500, 510, 300, 310))}, plain_ground());
    REQUIRE(labels.size() == 2);
    CHECK(labels[0].is_inside);
    CHECK((labels[0].box.x_low_m + labels[0].box.x_high_m) / 2 == Approx(200));
    CHECK((labels[0].box.z_low_m + labels[0].box.z_high_m) / 2 == Approx(150));
    CHECK_FALSE(labels[1].is_inside);
    CHECK_FALSE(meet(labels[1].box, {500, 510, 300, 310}));
    CHECK_FALSE(labels[1].leader);
    CHECK(std::abs(labels[1].box.z_low_m - 310) < 8);
}

TEST_CASE("a name avoids what is behind it, and says with a line what it belongs to") {
    LabelGround ground = plain_ground();
    ground.background = [](const PlanePoint& p) { return std::hypot(p.x_m - 500, p.z_m - 300) < 40 ? -1 : 0; };
    const auto labels = place_labels({solid(40, rectangle(495, 505, 295, 305))}, ground);
    REQUIRE(labels.size() == 1);
    for (const double x_m : {labels[0].box.x_low_m, labels[0].box.x_high_m}) {
        for (const double z_m : {labels[0].box.z_low_m, labels[0].box.z_high_m}) {
            CHECK(ground.background({x_m, z_m}) == 0);
        }
    }
    REQUIRE(labels[0].leader);
    const PlanePoint end = labels[0].leader->second;
    CHECK((end.x_m >= 495 && end.x_m <= 505 && end.z_m >= 295 && end.z_m <= 305));
}

TEST_CASE("a name without a free place is left out") {
    LabelGround ground = plain_ground();
    ground.background = [](const PlanePoint& /*at*/) { return -1; };
    CHECK(place_labels({solid(40, rectangle(495, 505, 295, 305))}, ground).empty());
    ground = plain_ground();
    Ring around = rectangle(0, 1000, 0, 600);
    around.push_back(around.front());
    ground.taken = {around};  // a line back to its first point takes its inside
    CHECK(place_labels({solid(40, rectangle(495, 505, 295, 305))}, ground).empty());
    CHECK(place_labels({solid(40, rectangle(100, 900, 100, 500))}, ground).empty());
}

TEST_CASE("names never overlap and stay within the area, however many there are") {
    test::Random random(7);
    const auto size = [&random] { return random.uniform(2, 120); };
    for (int round = 0; round < 10; ++round) {
        std::vector<NamedShape> shapes;
        for (int i = 0; i < 15; ++i) {
            const double left = random.uniform(0, 880);
            const double bottom = random.uniform(0, 480);
            const Ring outline = rectangle(left, left + size(), bottom, bottom + size());
            shapes.push_back(solid(30 + size(), outline));
            if (i % 3 == 0) {
                shapes.back().fill.clear();
            }
        }
        const auto labels = place_labels(shapes, plain_ground());
        CHECK(labels.size() > 5);
        for (std::size_t i = 0; i < labels.size(); ++i) {
            const Bounds& box = labels[i].box;
            CHECK((box.x_low_m >= 0 && box.x_high_m <= 1000 && box.z_low_m >= 0 && box.z_high_m <= 600));
            for (std::size_t k = 0; k < i; ++k) {
                CHECK_FALSE(meet(box, labels[k].box));
            }
        }
    }
}

TEST_CASE("of very many obstacles the largest have names, and goals have theirs") {
    FieldFigure figure;
    figure.extent = {0, 100, 0, 50};
    figure.value = [](double, double) { return 1.; };
    figure.scale = factor_scale("K", {0.9, 1.1});
    figure.points.push_back({});
    figure.points.back().points = {{95, 45}};
    figure.points.back().labels = {"goal"};
    std::vector<VisibleOutline> outlines;
    const auto count = static_cast<std::size_t>(test::repetitions(2000, 20000));
    const std::size_t large = count / 3;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t row = i / 200, column = i % 200;
        const double x_m = 0.4 * static_cast<double>(column), z_m = 0.4 * static_cast<double>(row);
        const Ring ring = i == large ? rectangle(90, 92, 20, 22) : rectangle(x_m, x_m + 0.1, z_m, z_m + 0.1);
        outlines.push_back({{}, {ring}, {ring}});
        outlines.back().outline.name = "n";
    }
    std::set<std::size_t> named;
    FieldLayout layout{};
    layout.right = 1000;
    for (const PlacedLabel& label : placed_names(figure, outlines, layout)) {
        named.insert(label.shape);
    }
    CHECK(named.size() <= 301);
    CHECK(named.count(large) == 1);
    CHECK(named.count(count) == 1);
}

TEST_CASE("in pictures of every shipped problem no name covers vehicle, paths, goal, other obstacles or bands of K") {
    std::size_t names = 0;
    for (const char* name : {"along_the_deck", "box_girder_bay", "bridge_inspection", "culvert", "girder_mesh",
                             "open_air", "pipe_rack", "window"}) {
        CAPTURE(name);
        Problem problem = read_problem(std::string(DOWNWASH_PROBLEMS "/") + name + ".yaml");
        problem.planner.variant = Variant::mp_arm;
        problem.uncertainty.reset();
        const RunRecord run = read_run(test::SolvedRun(problem).folder());
        const auto model = make_flight_model(run.problem);
        const FieldFigure figure = snapshot_figure(run, *model);
        const FieldLayout layout = layout_of(figure, 1200, {});
        const auto outlines = visible_outlines(figure.obstacles, figure.extent);
        const double px_m = (figure.extent.x_high_m - figure.extent.x_low_m) / layout.width();
        for (const PlacedLabel& label : placed_names(figure, outlines, layout)) {
            ++names;
            const Bounds& box = label.box;
            CAPTURE(outlines[label.shape].outline.name);
            for (double x_m = box.x_low_m; x_m <= box.x_high_m && !label.is_inside; x_m += px_m) {
                for (double z_m = box.z_low_m; z_m <= box.z_high_m; z_m += px_m) {
                    REQUIRE(figure.value(x_m, z_m) < 1.0101);  // NaN on obstacles and near them
                }
            }
            for (const FigureLines& lines : figure.lines) {
                for (const Ring& piece : lines.pieces) {
                    walk(piece, px_m, [&](const PlanePoint& p) { REQUIRE_FALSE(holds(box, p)); });
                }
            }
            for (const PlanePoint& goal : figure.points.empty() ? Ring{} : figure.points[0].points) {
                REQUIRE_FALSE(holds(
                    {box.x_low_m - 5 * px_m, box.x_high_m + 5 * px_m, box.z_low_m - 5 * px_m, box.z_high_m + 5 * px_m},
                    goal));
            }
        }
    }
    CHECK(names > 12);
}
