#include "downwash/report/factor_field.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "downwash/report/region_boundary.hpp"

using namespace downwash;

namespace {

MapLayer pipe_layer(AeroSettings settings = {}) {
    Obstacle pipe{"pipe", Cylinder{0.15, 8, {0, 1, 0}}, {0, 0, 2}, {}};
    const auto scene = std::make_shared<const Scene>(std::vector{pipe});
    return {std::make_shared<const DirectEffect>(scene, settings, 0.1905), 0};
}

}  // namespace

TEST_CASE("a contour of K near a pipe is smooth: it has no kinks that interpolation would make") {
    const auto field = factor_field(pipe_layer(), PlaneOfMotion());
    // The height over the pipe at which K falls below 1.01, by halving, across half its width.
    const auto height_m = [&field](double x_m) {
        double near = 2.3, far = 4;
        for (int i = 0; i < 50; ++i) {
            const double middle = (near + far) / 2;
            (field(x_m, middle) > 1.01 ? near : far) = middle;
        }
        return near;
    };
    constexpr double step_m = 0.01;
    for (double x_m = -0.12; x_m < 0.12; x_m += step_m) {
        const double bend_m = height_m(x_m - step_m) - 2 * height_m(x_m) + height_m(x_m + step_m);
        CAPTURE(x_m);
        CHECK(std::abs(bend_m) < 0.0015);  // a circle of 0.07 m radius bends by that much
    }
}

TEST_CASE("the scale of a part of a problem is that of the whole, and has classes below one only where K is") {
    FieldFigure figure;
    figure.value = [](double x_m, double /*z_m*/) { return x_m < 0 ? 0.93 : 1.2; };
    const Bounds whole{-4, 4, 0, 2};
    figure.extent = {1, 2, 0.5, 1};
    const ColorScale part = factor_scale("K", factor_range(figure, whole));
    figure.extent = whole;
    CHECK(part.limits == factor_scale("K", factor_range(figure, whole)).limits);
    CHECK(part.limits.front() < 1);
    figure.value = factor_field(pipe_layer(), PlaneOfMotion());
    figure.extent = {-1, 1, 1, 3};
    CHECK(factor_range(figure, figure.extent).low == 1);
}
