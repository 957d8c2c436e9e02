#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "downwash/base/key_error.hpp"
#include "downwash/effects/pipe_table.hpp"

using namespace downwash;

TEST_CASE("The mean over a pipe as wide as the disc by hand: a table that is constant near it") {
    // K - 1 = 0.4 up to 10 R, over the strip |x| < rho of the unit disc.
    const EffectTable flat({0.1, 10, 20}, {}, {1.4, 1.4, 1});
    CHECK(mean_over_pipe(flat.at(), 1, 0.5) == Approx(1.4).epsilon(1e-4));
    const double half = 2 / std::numbers::pi * (std::asin(0.5) + 0.5 * std::sqrt(0.75));  // of the disc is covered
    CHECK(mean_over_pipe(flat.at(), 0.5, 0.5) == Approx(1 + 0.4 * half).epsilon(1e-5));
    CHECK(mean_over_pipe(flat.at(), 0.5, 8.9) == Approx(1 + 0.4 * half).epsilon(1e-5));
}

TEST_CASE("The points of a measured pipe have the measurements as their means") {
    const EffectTable measured({0.4, 0.6, 1, 1.5, 2.5}, {}, {1.3, 1.2, 1.08, 0.98, 1.0});
    for (const double pipe_radii : {0.2, 0.5, 1.0, 3.0}) {
        CAPTURE(pipe_radii);
        const EffectTable points = points_of_pipe(measured, pipe_radii);
        for (std::size_t i = 0; i < measured.factors().size(); ++i) {
            CHECK(mean_over_pipe(points.at(), pipe_radii, measured.z_over_r()[i]) ==
                  Approx(measured.factors()[i]).margin(2e-9));
        }
        CHECK(points.factors()[0] > measured.factors()[0]);  // a part of the disc does it all
    }
    // A pipe a thousand times as wide is a flat surface.
    const EffectTable points = points_of_pipe(measured, 1000);
    for (std::size_t i = 0; i < measured.factors().size(); ++i) {
        CHECK(points.factors()[i] == Approx(measured.factors()[i]).margin(2e-4));
    }
}

TEST_CASE("Every second distance of a pipe's table has its own points") {
    const EffectTable measured({0.5, 1, 2}, {1, 3}, {1.2, 1.3, 1.1, 1.15, 1, 1.02});
    const EffectTable points = points_of_pipe(measured, 0.6);
    for (const std::size_t i : {0U, 1U, 2U, 3U, 4U, 5U}) {
        CHECK(mean_over_pipe(points.at(measured.d_over_r()[i % 2]), 0.6, measured.z_over_r()[i / 2]) ==
              Approx(measured.factors()[i]).margin(2e-9));
    }
}

TEST_CASE("A table that no pipe of its size can have is refused") {
    const EffectTable strong({0.5, 1}, {}, {90, 2});
    CHECK_THROWS_WITH(points_of_pipe(strong, 0.1), Catch::Contains("is the table of this pipe?"));
    const EffectTable weak({0.5, 1}, {}, {0.1, 1});
    CHECK_THROWS_AS(points_of_pipe(weak, 0.3), InputError);
}
