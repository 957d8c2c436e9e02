#include "downwash/report/factor_field.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "downwash/aeromap/aero_map.hpp"

using namespace downwash;

namespace {

MapLayer pipe_layer(AeroSettings settings = {}) {
    Obstacle pipe{"pipe", Cylinder{0.15, 8, {0, 1, 0}}, {0, 0, 2}, {}};
    const auto scene = std::make_shared<const Scene>(std::vector{pipe});
    return {std::make_shared<const DirectEffect>(scene, settings, 0.1905), 0};
}

}  // namespace

TEST_CASE("a contour of K near a pipe is smooth: it has no kinks that interpolation would make") {
    auto field = factor_field(pipe_layer(), PlaneOfMotion());
    const AeroMap map({pipe_layer()}, PlaneOfMotion(), {-1, 1, 1, 5});
    // The height over the pipe at which K falls below 1.01, by halving, across half its width.
    const auto height_m = [&field](double x_m) {
        double near = 2.3, far = 4;
        for (int i = 0; i < 50; ++i) {
            const double middle = (near + far) / 2;
            (field(x_m, middle) > 1.01 ? near : far) = middle;
        }
        return near;
    };
    const auto max_bend_m = [&height_m] {
        constexpr double step_m = 0.01;
        double max_m = 0;
        for (int i = -12; i <= 12; ++i) {
            const double x_m = i * step_m;
            max_m = std::max(max_m, std::abs(height_m(x_m - step_m) - 2 * height_m(x_m) + height_m(x_m + step_m)));
        }
        return max_m;
    };
    const double direct_m = max_bend_m();
    CHECK(direct_m < 0.0025);  // a circle of 0.04 m radius bends by that much
    field = [&map](double x_m, double z_m) { return map.factor(0, x_m, z_m); };
    CHECK(max_bend_m() > 2 * direct_m);
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
