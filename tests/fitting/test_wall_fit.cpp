#include "downwash/fitting/wall_fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

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
    const WallFit fit = fit_walls(read_wall_measurements(DOWNWASH_WALLS).points);
    CHECK(fit.points == 55);
    CHECK(fit.effect.decay_radii == Approx(WallEffect{}.decay_radii).epsilon(0.05));
    // Even beside a rotor that touches the wall the force stays below 2 % of the thrust.
    CHECK(fit.force.largest < 0.0135);
    REQUIRE(fit.force.standard_error);
    CHECK(std::abs(fit.effect.force) < 2 * *fit.force.standard_error);  // no sign is certain
    CHECK(fit.effect.moment > 4 * *fit.moment.standard_error);
}

TEST_CASE("A decay stays within the range of problem files, and says where it ends there") {
    // The same at both distances, as of a decay without end.
    const WallFit slow = fit_walls({{"", 1, 0.01, 0.03}, {"", 2, 0.01, 0.03}});
    CHECK(slow.effect.decay_radii == 20);
    CHECK(slow.is_decay_at_bound);
    // Nothing is left after half a radius.
    const WallFit quick = fit_walls({{"", 1, 0.01, 0.03}, {"", 1.5, 0, 0}});
    CHECK(quick.effect.decay_radii == 0.05);
    CHECK(quick.is_decay_at_bound);
    CHECK(quick.effect.moment == Approx(0.03));
    const WallFit within =
        fit_walls({{"", 1, 0.01, 0.03}, {"", 2, 0.01 * std::exp(-1 / 19.), 0.03 * std::exp(-1 / 19.)}});
    CHECK(within.effect.decay_radii == Approx(19).epsilon(1e-3));
    CHECK_FALSE(within.is_decay_at_bound);
}

TEST_CASE("A wall is fitted by the decays that leave something of it, and shares of nothing are 0") {
    // With 0.05 radii exp(-380) and less are left, squares of which are no numbers.
    std::vector<WallMeasurement> points;
    for (const double distance : {20.0, 24.0, 30.0}) {
        points.push_back({"one", distance, 0.01 * std::exp((20 - distance) / 5), 0.03 * std::exp((20 - distance) / 5)});
    }
    const WallFit far = fit_walls(points);
    CHECK(far.effect.decay_radii == Approx(5).epsilon(1e-4));
    CHECK(far.effect.moment == Approx(0.03 * std::exp(19 / 5.)).epsilon(1e-3));
    CHECK_FALSE(far.is_decay_at_bound);
    // Of another facility so far away that nothing is left with the decay of all.
    points.push_back({"two", 10000, 0.002, 0.004});
    points.push_back({"two", 10001, 0.002, 0.004});
    const WallFit both = fit_walls(points);
    REQUIRE(both.by_facility.size() == 2);
    const WallShare& nothing = both.by_facility[1].second.moment;
    CHECK(nothing.value == 0);
    CHECK_FALSE(nothing.standard_error);
    CHECK(nothing.rmse == Approx(0.004));
}

TEST_CASE("Walls at one distance only, or without a share, are refused") {
    const std::string no_decay =
        "the moments tell no decay: they are 0, or nothing of the wall is left so far from it; expected distances in "
        "rotor radii";
    CHECK_THROWS_WITH(fit_walls({{"", 1, 0.1, 0}, {"", 2, 0.2, 0}}), no_decay);
    CHECK_THROWS_WITH(fit_walls({{"", 10000, 0.1, 0.1}, {"", 20000, 0.2, 0.1}}), no_decay);
    CHECK_THROWS_WITH(fit_walls({{"", 2, 0.1, 0.1}, {"", 2, 0.2, 0.1}}), Catch::Contains("two distances"));
    CHECK_THROWS_WITH(parse_wall_measurements("distance_over_r,force_over_thrust\n2,0\n", "w.csv"),
                      Catch::Contains("w.csv:1: has no column moment_over_thrust_radius"));
    CHECK_THROWS_WITH(
        parse_wall_measurements("distance_over_r,force_over_thrust,moment_over_thrust_radius\n0.5,0,0\n", "w.csv"),
        Catch::Contains("w.csv:2:1: "));
}
