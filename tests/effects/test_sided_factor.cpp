#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "downwash/effects/sided_factor.hpp"

using namespace downwash;

TEST_CASE("The effect of a tilted rotor is half that of a level one where it is tilt loss times sin^2 of the tilt") {
    const double sine = std::sin(0.4);
    CHECK(tilted_change(0.3 * sine * sine, 0.3, sine) == Approx(0.15 * sine * sine).epsilon(1e-14));
    // By hand: K - 1 = 0.087 at 30 degrees, where sin^2 is 1/4.
    CHECK(tilted_change(0.087, 0.37, 0.5) == Approx(0.087 * 0.087 / (0.087 + 0.0925)).epsilon(1e-14));
}

TEST_CASE("A level rotor's effect, and none at all, stay what they are to the last bit") {
    test::Random random(5);
    for (int i = 0; i < 1000; ++i) {
        const double change = random.uniform(-0.5, 1);
        CHECK(tilted_change(change, 0.37, 0.0) == change);
        CHECK(tilted_change(change, 0.0, random.uniform(-1, 1)) == change);
    }
    CHECK(tilted_change(0.0, 0.37, 0.0) == 0);
    CHECK(tilted_change(0.0, 0.37, 0.7) == 0);
}

TEST_CASE("Tilt weakens an effect, either way alike, and never makes two of them differ more") {
    test::Random random(6);
    for (int i = 0; i < 20000; ++i) {
        const double loss = random.uniform(0, 2);
        const double sine = random.uniform(-1, 1);
        const double a = random.uniform(-0.5, 1);
        const double b = random.uniform(-0.5, 1);
        const double tilted_a = tilted_change(a, loss, sine);
        REQUIRE(std::abs(tilted_a) <= std::abs(a));
        REQUIRE(tilted_a * a >= 0);
        REQUIRE(tilted_a == tilted_change(a, loss, -sine));
        REQUIRE(std::abs(tilted_change(a, loss, 0.5 * sine)) >= std::abs(tilted_a));
        REQUIRE(std::abs(tilted_a - tilted_change(b, loss, sine)) <= std::abs(a - b) * (1 + 1e-12));
    }
}

TEST_CASE("Each side fades by its own loss") {
    const SidedFactor<double> level{1.5, 1.2};
    const SidedFactor<double> over_ground = tilted(level, {0.4, 0}, 0.5);
    CHECK(over_ground.above == 1.2);
    CHECK(over_ground.all == Approx(1.2 + 0.3 * 0.3 / (0.3 + 0.1)).epsilon(1e-14));
    const SidedFactor<double> under_ceiling = tilted(level, {0, 0.4}, 0.5);
    CHECK(under_ceiling.above == Approx(1 + 0.2 * 0.2 / (0.2 + 0.1)).epsilon(1e-14));
    CHECK(under_ceiling.all == Approx(under_ceiling.above + 0.3).epsilon(1e-14));
}
