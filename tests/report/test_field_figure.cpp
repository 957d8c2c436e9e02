#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "downwash/base/key_error.hpp"
#include "downwash/report/field_figure.hpp"
#include "pictures.hpp"

using namespace downwash;
using Catch::Matchers::Contains;
using test::texts_of;

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// A field around a pole at the origin, not defined near it, with a box to the right.
FieldFigure sample_figure() {
    FieldFigure figure;
    figure.title = "A pole and a box";
    figure.subtitle = "for the test";
    figure.extent = {-4, 4, -2, 2};
    figure.scale = factor_scale("K [1]", {1, 2});
    figure.value = [](double x_m, double z_m) {
        const double r = std::hypot(x_m, z_m);
        return r < 0.5 ? undefined : 1 + 0.01 / (r * r);
    };
    figure.obstacles = {{"box_of_bricks", true, {{{2, -1}, {3, -1}, {3, 1}, {2, 1}}}, {}},
                        {"sheet", true, {}, {{{-3, 0}, {-2, 1}}}},
                        {"beside", false, {{{-1, -1}, {1, -1}, {1, 1}}}, {}}};
    figure.lines = {{"a boundary", {{{-4, 1}, {0, 1.5}, {4, 1}}}, {200, 0, 0}, 2, LineDash::dashed, true}};
    figure.points = {{"a point", {{1, 1}}, {0, 0, 200}}};
    return figure;
}

}  // namespace

TEST_CASE("a picture in SVG is sound XML and says everything") {
    const std::string picture = draw(sample_figure(), {PictureFormat::svg, 1000});
    CHECK_THAT(test::svg_texts(picture),
               Contains("A pole and a box") && Contains("for the test") && Contains("K [1]") && Contains("x [m]") &&
                   Contains("z [m]") && Contains("not flyable") && Contains("obstacle") &&
                   Contains("obstacle beside the plane, projected") && Contains("box_of_bricks") && Contains("sheet") &&
                   Contains("beside") && Contains("a boundary") && Contains("a point") && Contains("1.01") &&
                   Contains("1.02") && Contains("1.05") && Contains("1.1") && Contains("1.2") && Contains("1.3") &&
                   Contains("1.5"));
    CHECK_THAT(picture, Contains("data:image/png;base64,"));
    const std::string size = picture.substr(picture.find("width="), 12);
    CHECK(size == "width=\"1000\"");
    CHECK(picture.size() < 500'000);
}

TEST_CASE("a picture in PNG has the width that was asked for, and one scale for both axes") {
    for (const int width_px : {400, 1200}) {
        const auto [width, height] = test::png_size(draw(sample_figure(), {PictureFormat::png, width_px}));
        CHECK(width == static_cast<unsigned>(width_px));
        // Half as high as wide, and what stands around it.
        CHECK(height > 0.5 * (width_px - 104) + 150);
        CHECK(height < 0.5 * (width_px - 104) + 360);
    }
}

TEST_CASE(
    "a field that is defined everywhere has no entry for where it is not, and one that is nowhere has no colours") {
    FieldFigure figure = sample_figure();
    figure.value = [](double, double) { return 1.0; };
    CHECK_THAT(texts_of(figure), !Contains("not flyable"));
    figure.value = [](double, double) { return undefined; };
    const std::string nowhere = draw(figure, {PictureFormat::svg, 500});
    CHECK_THAT(test::svg_texts(nowhere), Contains("not flyable"));
    CHECK_THAT(nowhere, !Contains("data:image/png"));
}

TEST_CASE("kinds are named at the colour bar instead of numbers, obstacles that look the same share one name tag") {
    FieldFigure figure = sample_figure();
    figure.scale = scale_of_kinds("hover", {"unstable", "stable"}, {{200, 0, 0}, {0, 200, 0}});
    figure.value = [](double x_m, double) { return x_m < 0 ? 0.0 : 1.0; };
    CHECK_THAT(texts_of(figure), Contains("\nunstable\n") && Contains("\nstable\n") && Contains("\nhover\n"));
    figure.obstacles.push_back(figure.obstacles[0]);
    figure.obstacles.back().name = "its_twin";
    CHECK_THAT(texts_of(figure, 900), Contains("box_of_bricks, its_twin"));
}

TEST_CASE("names that would run commands are shown as they are") {
    const test::WorkingFolder folder;
    for (const std::string& text : test::hostile_texts()) {
        FieldFigure figure = sample_figure();
        figure.title = figure.subtitle = figure.x_label = figure.z_label = figure.undefined_name = text;
        figure.scale.label = text;
        figure.obstacles[0].name = figure.lines[0].name = figure.points[0].name = text;
        CHECK_THAT(texts_of(figure, 700), Contains("beside"));  // the drawing went on to its end
        figure.scale = scale_of_kinds(text, {text, text}, {{}, {}});
        CHECK(test::png_size(draw(figure, {PictureFormat::png, 700}))[0] == 700);
    }
    CHECK(folder.is_empty());
}

TEST_CASE("a name that would end a section of XML is escaped in an SVG") {
    FieldFigure figure = sample_figure();
    figure.title = figure.obstacles[0].name = "a]]>]]>b";
    const std::string picture = draw(figure, {PictureFormat::svg, 900});
    CHECK_THAT(picture, !Contains("]]>") && Contains("a]]&gt;]]&gt;b"));
    CHECK_THAT(test::svg_texts(picture), Contains("a]]>]]>b"));
}

TEST_CASE("what cannot be drawn to scale is an error") {
    const auto with_extent = [](const Bounds& extent) {
        FieldFigure figure = sample_figure();
        figure.extent = extent;
        return figure;
    };
    const PictureSettings settings{PictureFormat::svg, 800};
    for (const Bounds& extent : {Bounds{1, 1, 0, 1}, {0, 1, 2, 1}, {0, undefined, 0, 1}}) {
        CHECK_THROWS_WITH(draw(with_extent(extent), settings), Contains("hold no area"));
    }
    CHECK_THROWS_WITH(draw(with_extent({0, 100, 0, 1}), settings), Contains("40 times"));
    CHECK_THROWS_AS(draw(sample_figure(), {PictureFormat::svg, 399}), InputError);
    CHECK_THROWS_AS(draw(sample_figure(), {PictureFormat::svg, 8001}), InputError);
    CHECK(test::png_size(draw(with_extent({0, 1, 0, 39}), {PictureFormat::png, 400}))[0] == 400);
}
