#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/effects/potential_flow.hpp"

using namespace downwash;

namespace {

/// Central difference of one component along one axis.
double slope(const Vector3& at, double height, std::size_t component, std::size_t axis) {
    constexpr double step = 1e-4;
    Vector3 ahead = at, behind = at;
    ahead[axis] += step;
    behind[axis] -= step;
    return (potential_flow_velocity(ahead, height)[component] - potential_flow_velocity(behind, height)[component]) /
           (2 * step);
}

}  // namespace

TEST_CASE("away from the two sources the potential flow has neither divergence nor curl") {
    test::Random random(11);
    for (int i = 0; i < 200; ++i) {
        const double height = random.uniform(0.3, 3);
        const Vector3 at{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
        const double nearest =
            std::min(std::hypot(at[0], at[1], at[2] - height), std::hypot(at[0], at[1], at[2] + height));
        if (nearest < 0.5) {
            continue;
        }
        CHECK(slope(at, height, 0, 0) + slope(at, height, 1, 1) + slope(at, height, 2, 2) == Approx(0).margin(1e-6));
        CHECK(slope(at, height, 2, 1) == Approx(slope(at, height, 1, 2)).margin(1e-6));
        CHECK(slope(at, height, 0, 2) == Approx(slope(at, height, 2, 0)).margin(1e-6));
    }
}

TEST_CASE("no air passes through the ground") {
    for (const double x : {-2.0, 0.0, 0.1, 5.0}) {
        CHECK(potential_flow_velocity({x, 0.7, 0}, 1.3)[2] == 0);
    }
    CHECK(potential_flow_velocity({0.5, 0, 0}, 1)[0] > 0);
    CHECK_FALSE(std::isfinite(potential_flow_velocity({0, 0, 1}, 1)[2]));  // at the source itself
}

TEST_CASE("the image's axial velocity at the rotor is that of (2.7) and (2.8), and gives the ground effect (2.9)") {
    for (const double height : {0.5, 1.0, 2.5}) {
        // Just above and below the rotor its own velocity is equal and opposite.
        const double above = potential_flow_velocity({0, 0, height + 1e-3}, height)[2];
        const double below = potential_flow_velocity({0, 0, height - 1e-3}, height)[2];
        const double induced = (above + below) / 2;
        CHECK(induced == Approx(1 / (16 * height * height)).epsilon(1e-5));
        CHECK(1 / (1 - induced) == Approx(formula_factor(EffectModel::cheeseman_bennett, height)).epsilon(1e-5));
    }
}

TEST_CASE("through a closed surface around the rotor flows what its disc drives through") {
    // Strength s = R^2 v_i / 4: the flux 4 pi s is the disc's area times v_i.
    const double height = 2, radius = 0.5;
    constexpr int rings = 200, around = 200;
    constexpr double pi = 3.14159265358979323846;
    double flux = 0;
    for (int i = 0; i < rings; ++i) {
        const double cosine = -1 + 2 * (i + 0.5) / rings, sine = std::sqrt(1 - cosine * cosine);
        for (int k = 0; k < around; ++k) {
            const double turn = 2 * pi * k / around;
            const Vector3 normal{sine * std::cos(turn), sine * std::sin(turn), cosine};
            const Vector3 v =
                potential_flow_velocity({radius * normal[0], radius * normal[1], height + radius * normal[2]}, height);
            flux +=
                (v[0] * normal[0] + v[1] * normal[1] + v[2] * normal[2]) * 4 * pi * radius * radius / (rings * around);
        }
    }
    CHECK(flux == Approx(pi).epsilon(1e-4));
}
