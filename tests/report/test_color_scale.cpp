#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "../support/random.hpp"
#include "downwash/report/color_scale.hpp"

using namespace downwash;

namespace {

/// Relative luminance as WCAG 2 defines it.
double luminance(const Color& color) {
    const auto linear = [](double byte) {
        const double c = byte / 255;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(color.red) + 0.7152 * linear(color.green) + 0.0722 * linear(color.blue);
}

void check_is_sound(const ColorScale& scale) {
    REQUIRE(scale.colors.size() >= 2);
    REQUIRE(scale.limits.size() == scale.colors.size() + 1);
    for (std::size_t i = 0; i + 1 < scale.limits.size(); ++i) {
        CHECK(scale.limits[i] < scale.limits[i + 1]);
    }
}

}  // namespace

TEST_CASE("thrust ratios at or above one have limits that are finest at one, and ever darker colours") {
    const std::vector<double> usual{1, 1.01, 1.02, 1.05, 1.1, 1.2, 1.3, 1.5, 2};
    for (const auto& [low, high] : {std::pair(1.0, 1.0), {1.0, 1.04}, {1.0, 2.0}, {1 - 1e-7, 2 + 1e-7}}) {
        const ColorScale scale = factor_scale("K", {low, high});
        check_is_sound(scale);
        CHECK(scale.limits == usual);
        CHECK(scale.colors.front() == Color{255, 255, 255});
    }
    CHECK(factor_scale("K", {1, 50}).limits.back() == 101);
    // Each colour is darker than the one before.
    for (const ColorScale& rising : {factor_scale("K", {1, 2}), factor_scale("K", {1, 50})}) {
        for (std::size_t i = 0; i + 1 < rising.colors.size(); ++i) {
            CHECK(luminance(rising.colors[i + 1]) < luminance(rising.colors[i]));
        }
    }
}

TEST_CASE("thrust ratios above one are blue, below one yellow to brown, about one white") {
    const ColorScale scale = factor_scale("K", {0.93, 1.2});
    check_is_sound(scale);
    CHECK(scale.limits.front() == Approx(0.9));
    CHECK(scale.limits.back() == 2);
    const auto color_of = [&](double value) {
        return scale.colors[static_cast<std::size_t>(position_on(scale, value))];
    };
    for (const double one : {0.995, 1.0, 1.005}) {
        CHECK(color_of(one) == Color{255, 255, 255});
    }
    CHECK(color_of(1.04).blue > color_of(1.04).red);
    CHECK(color_of(0.96).red > color_of(0.96).blue);
    CHECK(luminance(color_of(0.91)) < luminance(color_of(0.96)));
    CHECK(factor_scale("K", {0, 1}).limits.front() == Approx(0.0).margin(1e-12));
}

TEST_CASE("a thrust ratio has the same colour on every scale") {
    const ColorScale all = factor_scale("K", {0, 100});
    test::Random random(3);
    for (int i = 0; i < 200; ++i) {
        const double low = random.uniform(0, 1.5), high = random.uniform(1, 4);
        const ColorScale scale = factor_scale("K", {low, high});
        for (std::size_t k = 0; k < scale.colors.size(); ++k) {
            const double middle = (scale.limits[k] + scale.limits[k + 1]) / 2;
            REQUIRE(scale.colors[k] == all.colors[static_cast<std::size_t>(position_on(all, middle))]);
        }
    }
}

TEST_CASE("a value stands within its class, and those outside at the ends") {
    const ColorScale scale{"v", {0, 1, 10, 100}, {{}, {}, {}}, {}};
    for (const auto& [value, position] : {std::pair(0.0, 0.0),
                                          {0.25, 0.25},
                                          {1.0, 1.0},
                                          {5.5, 1.5},
                                          {55.0, 2.5},
                                          {100.0, 3.0},
                                          {-7.0, 0.0},
                                          {HUGE_VAL, 3.0}}) {
        CHECK(position_on(scale, value) == position);
    }
    CHECK(std::isnan(position_on(scale, std::numeric_limits<double>::quiet_NaN())));
}

TEST_CASE("a signed scale is symmetric, with limits at 1, 2 and 5 times powers of ten") {
    const ColorScale scale = signed_scale("w", 0.7, 5);
    check_is_sound(scale);
    const std::vector<double> expected{-1, -0.5, -0.2, -0.1, -0.05, 0.05, 0.1, 0.2, 0.5, 1};
    REQUIRE(scale.limits.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CHECK(scale.limits[i] == Approx(expected[i]));
    }
    CHECK(signed_scale("w", 30, 3).limits.back() == Approx(50));
}

TEST_CASE("kinds stand in the middle of their fields") {
    const ColorScale scale = scale_of_kinds("hover", {"no", "perhaps", "yes"}, {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
    check_is_sound(scale);
    for (int kind = 0; kind < 3; ++kind) {
        CHECK(position_on(scale, kind) == kind + 0.5);
    }
}
