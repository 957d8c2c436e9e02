#include "downwash/fitting/wall_fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/base/key_error.hpp"

using namespace downwash;

TEST_CASE("Walls that follow the law are found, and each facility's share with the decay of all") {
    std::vector<WallMeasurement> points;
    for (const double distance : {1.0, 1.5, 2.0, 4.0}) {
        const double fading = std::exp(-(distance - 1) / 0.8);
        points.push_back({"one", distance, -0.01 * fading, 0.03 * fading});
        points.push_back({"two", distance, 0.02 * fading, 0.05 * fading});
    }
    const WallFit fit = fit_walls(points);
    CHECK(fit.points == 8);
    CHECK(fit.effect.decay_radii == Approx(0.8).epsilon(1e-4));
    CHECK(fit.effect.force == Approx(0.005).epsilon(1e-3));  // midway between them
    CHECK(fit.effect.moment == Approx(0.04).epsilon(1e-3));
    CHECK(fit.moment.largest == 0.05);
    REQUIRE(fit.by_facility.size() == 2);
    CHECK(fit.by_facility[0].first == "one");
    CHECK(fit.by_facility[0].second.effect.force == Approx(-0.01).epsilon(1e-3));
    CHECK(fit.by_facility[1].second.effect.moment == Approx(0.05).epsilon(1e-3));
    CHECK(fit.by_facility[1].second.moment.rmse < 1e-5);
    REQUIRE(fit.moment.standard_error);
    // Residuals of 0.01 times the fading, of 8 points: sqrt(sum / 7 / shapes).
    CHECK(*fit.moment.standard_error == Approx(0.01 / std::sqrt(7)).epsilon(1e-3));
}

TEST_CASE("The default decay of walls is that of the shipped measurements, and walls are weak") {
    const WallFit fit = fit_walls(read_wall_measurements(DOWNWASH_WALLS));
    CHECK(fit.points == 55);
    CHECK(fit.effect.decay_radii == Approx(WallEffect{}.decay_radii).epsilon(0.05));
    // Even beside a rotor that touches the wall the force stays below 2 % of the thrust.
    CHECK(fit.force.largest < 0.0135);
    REQUIRE(fit.force.standard_error);
    CHECK(std::abs(fit.effect.force) < 2 * *fit.force.standard_error);  // no sign is certain
    CHECK(fit.effect.moment > 4 * *fit.moment.standard_error);
}

TEST_CASE("Walls at one distance only, or without a share, are refused") {
    CHECK_THROWS_WITH(fit_walls({{"", 2, 0.1, 0.1}, {"", 2, 0.2, 0.1}}), Catch::Contains("two distances"));
    CHECK_THROWS_WITH(parse_wall_measurements("distance_over_r,force_over_thrust\n2,0\n", "w.csv"),
                      Catch::Contains("w.csv:1: has no column moment_over_thrust_radius"));
    CHECK_THROWS_WITH(
        parse_wall_measurements("distance_over_r,force_over_thrust,moment_over_thrust_radius\n0.5,0,0\n", "w.csv"),
        Catch::Contains("w.csv:2: "));
}
