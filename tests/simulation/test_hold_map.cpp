#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/simulation/hold_map.hpp"

using namespace downwash;
using test::quarter_turn;

TEST_CASE("a hold map holds the analysis of each of its nodes") {
    const auto model = make_flight_model(test::ceiling_problem());
    const HoldMap map = make_hold_map(*model, {-1, 1, 1, 5}, 0.25, quarter_turn);
    REQUIRE(map.columns == 9);
    REQUIRE(map.rows == 17);
    REQUIRE(map.verdicts.size() == 9 * 17);
    for (std::size_t node = 0; node < map.verdicts.size(); ++node) {
        const auto column = static_cast<double>(node % map.columns);
        const auto row = static_cast<double>(node / map.columns);
        const HoverAnalysis a = analyse_hover(*model, -1 + 0.25 * column, 1 + 0.25 * row, quarter_turn);
        CHECK(map.verdicts[node] == a.verdict);
        const double rate_1_s = map.growth_rates_1_s[node];
        CHECK((a.verdict >= HoldVerdict::unstable ? rate_1_s == a.stability.growth_rate_1_s : std::isnan(rate_1_s)));
    }
    // From the top: in the ceiling, under it (0.19 m, unstable), farther away, the arm in the ground.
    const auto verdict_at_row = [&](std::size_t row) { return map.verdicts[row * map.columns + 4]; };
    CHECK(verdict_at_row(16) == HoldVerdict::not_flyable);
    CHECK(verdict_at_row(15) == HoldVerdict::unstable);
    CHECK(verdict_at_row(12) == HoldVerdict::stable);
    CHECK(verdict_at_row(0) == HoldVerdict::in_collision);
}

TEST_CASE("a hold map does not depend on the number of threads") {
    const auto model = make_flight_model(test::ceiling_problem());
    const HoldMap one = make_hold_map(*model, {-3, 3, 1, 5}, 0.2, 0.3, 1);
    const HoldMap three = make_hold_map(*model, {-3, 3, 1, 5}, 0.2, 0.3, 3);
    CHECK(one.verdicts == three.verdicts);
    REQUIRE(one.growth_rates_1_s.size() == three.growth_rates_1_s.size());
    CHECK(std::memcmp(one.growth_rates_1_s.data(), three.growth_rates_1_s.data(),
                      one.growth_rates_1_s.size() * sizeof(double)) == 0);
}

TEST_CASE("the last node of a hold map lies on the bound where the step divides it") {
    Problem problem = test::ceiling_problem();
    problem.obstacles.clear();
    const auto model = make_flight_model(problem);
    const HoldMap fits = make_hold_map(*model, {0, 0.3, 0, 0.7}, 0.1, 0);
    CHECK(fits.columns == 4);
    CHECK(fits.rows == 8);
    const HoldMap does_not = make_hold_map(*model, {0, 0.39, 0, 0.05}, 0.1, 0);
    CHECK(does_not.columns == 4);
    CHECK(does_not.rows == 1);
}

TEST_CASE("hold maps without extent, without a step or too large are errors") {
    const auto model = make_flight_model(test::ceiling_problem());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Bounds bounds{-1, 1, 1, 5};
    for (const double x_low_m : {1.0, nan}) {
        CHECK_THROWS_WITH(make_hold_map(*model, {x_low_m, 1, 0, 1}, 0.1, 0),
                          Catch::Contains("low end below the high one"));
    }
    for (const double step_m : {0.0, -0.1, nan, std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_WITH(make_hold_map(*model, bounds, step_m, 0), Catch::Contains("expected a distance above 0 m"));
    }
    for (const double step_m : {1e-4, 1e-300}) {
        CHECK_THROWS_WITH(make_hold_map(*model, bounds, step_m, 0), Catch::Contains("at most 1048576"));
    }
    CHECK_THROWS_AS(make_hold_map(*model, {-1e308, 1e308, 0, 1}, 0.1, 0), InputError);
}

TEST_CASE("the stability boundary under a wide ceiling is level, where the analysis changes its verdict") {
    const auto model = make_flight_model(test::ceiling_problem());
    const HoldMap map = make_hold_map(*model, {-1, 1, 3, 4.85}, 0.1, quarter_turn);
    const auto boundary = stability_boundary(*model, map);
    REQUIRE(boundary.size() == 1);
    REQUIRE(boundary[0].size() == map.columns);
    for (const HoldPoint& at : boundary[0]) {
        CHECK(at.z_m == Approx(5 - 0.06 - 0.3213).margin(1e-3));
        CHECK(analyse_hover(*model, at.x_m, at.z_m - 2e-4, quarter_turn).verdict == HoldVerdict::stable);
        CHECK(analyse_hover(*model, at.x_m, at.z_m + 2e-4, quarter_turn).verdict == HoldVerdict::unstable);
    }
}
