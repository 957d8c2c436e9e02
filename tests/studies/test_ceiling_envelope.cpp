#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "downwash/studies/ceiling_envelope.hpp"

using namespace downwash;
using namespace downwash::studies;

namespace {

constexpr double degree = std::numbers::pi / 180;
const SurfaceEffect ceiling(EffectModel::sanchez_cuevas);

/// (2.18) for R = 0.1194 m.
double k(double z_m) {
    const double r = 0.1194 / (z_m + 0.3168 * 0.1194);
    return 1 / (1 - r * r / 6.924);
}

}  // namespace

TEST_CASE("The difference between the rotors is that of (2.18) at both heights") {
    const RotorPair pair{0.25, 0.1194};
    for (const double pitch_deg : {3.0, 10.0, -10.0}) {
        const double rise = 0.25 * std::sin(pitch_deg * degree);
        CHECK(difference_between_rotors(ceiling, pair, pitch_deg * degree, 0.2) ==
              Approx(k(0.2 - rise) / k(0.2 + rise) - 1).epsilon(1e-9));
    }
    CHECK(difference_between_rotors(ceiling, pair, 0, 0.2) == 0);
    CHECK(std::isinf(difference_between_rotors(ceiling, pair, 10 * degree, 0.04)));
}

TEST_CASE("At the least distance the difference is what is allowed, and nearer it is more") {
    const RotorPair pair;
    for (const double pitch_deg : {1.0, 5.0, 15.0}) {
        for (const double most : {0.02, 0.1}) {
            const double z = least_distance_m(ceiling, pair, pitch_deg * degree, most);
            CHECK(difference_between_rotors(ceiling, pair, pitch_deg * degree, z) == Approx(most).margin(1e-4));
            CHECK(difference_between_rotors(ceiling, pair, pitch_deg * degree, z - 0.01) > most);
        }
    }
}

TEST_CASE("The three statements of the thesis hold for rotors 0.25 m out, and not all of them for 0.24 m") {
    const Study study = ceiling_envelope();
    REQUIRE(study.findings.size() == 7);
    for (const int i : {0, 1, 2, 6}) {
        CHECK(study.findings[static_cast<std::size_t>(i)].is_reproduced);
    }
    CHECK(!study.findings[3].is_reproduced);
}
