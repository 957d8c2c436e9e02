#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "downwash/aeromap/effect_models.hpp"

using namespace downwash;

namespace {

const SurfaceEffect ground{EffectModel::cheeseman_bennett};
const SurfaceEffect ceiling{EffectModel::sanchez_cuevas};
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("Cheeseman and Bennett's factor has the hand-computed values") {
    CHECK(surface_factor(ground, 0.5, 10) == Approx(4.0 / 3).epsilon(1e-14));
    CHECK(surface_factor(ground, 1, 10) == Approx(16.0 / 15).epsilon(1e-14));
    CHECK(surface_factor(ground, 2, 10) == Approx(64.0 / 63).epsilon(1e-14));
}

TEST_CASE("Sanchez-Cuevas' factor has the hand-computed values") {
    // zeta + K2/R = 1 and 2: K = 1 / (1 - 1 / 6.924) and 1 / (1 - 1 / 27.696)
    CHECK(surface_factor(ceiling, 0.6832, 10) == Approx(6.924 / 5.924).epsilon(1e-14));
    CHECK(surface_factor(ceiling, 1.6832, 10) == Approx(27.696 / 26.696).epsilon(1e-14));
    CHECK(surface_factor({EffectModel::sanchez_cuevas, 4, 0}, 1, 10) == Approx(4.0 / 3).epsilon(1e-14));
}

TEST_CASE("The ceiling model gives the percentages of the thesis at three attitudes") {
    // Thesis (4.6): a rotor radius of 0.1194 m, rotors 0.25 m from the centre whose distance to the ceiling is z.
    const auto percent_more = [](double pitch_deg, double z) {
        const double lift = 0.25 * std::sin(pitch_deg * 3.14159265358979323846 / 180);
        const double near = surface_factor(ceiling, (z - lift) / 0.1194, 2);
        const double far = surface_factor(ceiling, (z + lift) / 0.1194, 2);
        return 100 * (near / far - 1);
    };
    CHECK(percent_more(10, 0.10) == Approx(21.9).margin(0.05));
    CHECK(percent_more(3, 0.10) == Approx(4.8).margin(0.05));
    CHECK(percent_more(10, 0.25) == Approx(1.6).margin(0.05));
}

TEST_CASE("Factors stay between 1 and the cap, below the pole too") {
    for (const SurfaceEffect& effect : {ground, ceiling}) {
        for (double zeta = 0; zeta < 5; zeta += 0.001) {
            const double factor = surface_factor(effect, zeta, 2);
            REQUIRE(factor >= 1);
            REQUIRE(factor <= 2);
            REQUIRE(factor >= surface_factor(effect, zeta + 0.001, 2));
        }
        CHECK(surface_factor(effect, 0, 2) == 2);
        CHECK(surface_factor(effect, 0.01, 1.5) == 1.5);
        CHECK(surface_factor(effect, infinity, 2) == 1);
    }
    CHECK(surface_factor(ground, 0.25, 2) == 2);
    CHECK(surface_factor({EffectModel::none}, 0, 2) == 1);
}

TEST_CASE("Models are found by the name that a problem file uses") {
    for (const char* name : {"none", "cheeseman-bennett", "sanchez-cuevas"}) {
        const EffectModelInfo* found = find_effect_model(name);
        REQUIRE(found != nullptr);
        CHECK(found->name == name);
        CHECK(&info(found->model) == found);
    }
    CHECK(find_effect_model("cheeseman") == nullptr);
    CHECK(find_effect_model("") == nullptr);
}
