#include <catch2/catch.hpp>
#include <limits>

#include "downwash/base/key_error.hpp"
#include "downwash/report/curve_figure.hpp"
#include "pictures.hpp"

using namespace downwash;
using Catch::Matchers::Contains;
using test::texts_of;

namespace {

CurveFigure sample_figure() {
    CurveFigure figure;
    figure.title = "K over z/R";
    figure.x_label = "z/R";
    figure.y_label = "K";
    figure.level = 1;
    figure.curves = {
        {"a formula", {{0, 2}, {1, 1.2}, {std::numeric_limits<double>::quiet_NaN(), 0}, {2, 1.1}, {3, 1}}}};
    figure.measurements = {{"measured", {{0.5, 1.5}, {1.5, 1.1}}, {0.1, 0.05}}, {"once", {{2, 1.05}}, {}}};
    return figure;
}

}  // namespace

TEST_CASE("a diagram names its axes, curves and measurements") {
    CHECK_THAT(texts_of(sample_figure(), 800), Contains("K over z/R") && Contains("\nz/R\n") && Contains("\nK\n") &&
                                                   Contains("a formula") && Contains("measured") && Contains("once"));
    CHECK(test::png_size(draw(sample_figure(), {PictureFormat::png, 800}))[0] == 800);
}

TEST_CASE("diagrams stand one below the other, each with what is its own") {
    std::vector<CurveFigure> figures{sample_figure(), sample_figure()};
    figures[1].title.clear();
    figures[1].y_label = "residual";
    const std::string one = draw(std::span(figures).first(1), {PictureFormat::png, 600});
    const std::string two = draw(figures, {PictureFormat::png, 600});
    CHECK(test::png_size(two)[1] > test::png_size(one)[1] + 100);
    const std::string texts = texts_of(figures);
    CHECK_THAT(texts, Contains("residual"));
    CHECK(texts.find("K over z/R") == texts.rfind("K over z/R"));
    CHECK(draw(figures, {PictureFormat::svg, 600}) == draw(figures, {PictureFormat::svg, 600}));
    // Many curves of one value are drawn too.
    CurveFigure many;
    for (int i = 0; i < 40; ++i) {
        many.curves.push_back({"curve " + std::to_string(i), {{0, 1}, {1, 1}}});
    }
    CHECK_THAT(texts_of(many, 500), Contains("curve 39"));
}

TEST_CASE("names of curves that would run commands are shown as they are") {
    const test::WorkingFolder folder;
    for (const std::string& text : test::hostile_texts()) {
        CurveFigure figure = sample_figure();
        figure.title = figure.subtitle = figure.x_label = figure.y_label = text;
        figure.curves[0].name = figure.measurements[0].name = text;
        CHECK_THAT(texts_of(figure, 700), Contains("once"));
    }
    CHECK(folder.is_empty());
}

TEST_CASE("diagrams without anything to draw are errors") {
    const PictureSettings settings{PictureFormat::svg, 800};
    CHECK_THROWS_WITH(draw(std::span<const CurveFigure>(), settings), Contains("no figure"));
    CHECK_THROWS_WITH(draw(CurveFigure{}, settings), Contains("nothing to draw"));
    CurveFigure figure = sample_figure();
    figure.measurements[0].errors.pop_back();
    CHECK_THROWS_WITH(draw(figure, settings), Contains("2 points have 1 errors"));
    figure = sample_figure();
    figure.x_range = {2, 2};
    CHECK_THROWS_WITH(draw(figure, settings), Contains("2 to 2 is empty"));
    CHECK_THROWS_AS(draw(sample_figure(), {PictureFormat::svg, 10}), InputError);
}

TEST_CASE("a curve is dotted outside the range in which it is known, and the legend says so") {
    CurveFigure figure;
    figure.curves = {{"known in the middle", {{0, 1}, {1, 1.1}, {2, 1.2}, {3, 1.3}}, AxisRange{1, 2}},
                     {"known everywhere", {{0, 1}, {3, 1.2}}}};
    figure.dotted_name = "nobody has measured";
    const std::string picture = draw(figure, {PictureFormat::svg, 800});
    CHECK_THAT(test::svg_texts(picture), Contains("nobody has measured"));
    const auto dotted_lines = [](const std::string& svg) {
        std::size_t count = 0;
        for (std::size_t at = svg.find("stroke-dasharray"); at != std::string::npos;
             at = svg.find("stroke-dasharray", at + 1)) {
            ++count;
        }
        return count;
    };
    figure.curves[0].known_range = AxisRange{0, std::numeric_limits<double>::infinity()};
    const std::string whole = draw(figure, {PictureFormat::svg, 800});
    CHECK(dotted_lines(picture) > dotted_lines(whole));  // gnuplot writes some of its own
    CHECK_THAT(test::svg_texts(whole), !Contains("nobody has measured"));
    figure.curves = {{"known nowhere here", {{0, 1}, {1, 1.1}}, AxisRange{5, 6}}};
    CHECK_NOTHROW(draw(figure, {PictureFormat::svg, 800}));
}

TEST_CASE("a curve that lies over another is broken, so that both can be seen") {
    CurveFigure figure;
    figure.y_range = AxisRange{0, 3};
    figure.curves = {{"below", {{0, 1}, {1, 2}}}, {"above", {{0, 1}, {1, 2}}}};
    const auto dashed_lines = [&figure] {
        const std::string picture = draw(figure, {PictureFormat::svg, 600});
        int count = 0;
        for (std::size_t at = picture.find("dasharray"); at != std::string::npos;
             at = picture.find("dasharray", at + 1)) {
            ++count;
        }
        return count;
    };
    const int with_both = dashed_lines();
    figure.curves[1].points[1].y = 2.5;
    CHECK(dashed_lines() == with_both - 2);  // the curve and its sample in the legend
}
