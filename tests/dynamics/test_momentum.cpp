#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/dynamics/momentum.hpp"
#include "random_plant.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

Four momentum_at(const PlantModel& model, const Four& q, const Four& u) {
    Four p{};
    dynamics::momentum(model, dynamics::motion_at(model, q.data(), u.data()).equations, u.data(), p.data());
    return p;
}

}  // namespace

TEST_CASE("u . p is twice the kinetic energy") {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const PlantModel model = RandomPlant(random).model;
        const Four q = random_four(random, 3);
        const Four u = random_four(random, 3);
        const Four p = momentum_at(model, q, u);
        const auto equations = dynamics::motion_at(model, q.data(), u.data()).equations;
        const double product = u[0] * p[0] + u[1] * p[1] + u[2] * p[2] + u[3] * p[3];
        CHECK(product == Approx(2 * dynamics::kinetic_energy(model, equations, u.data())).epsilon(1e-12));
    }
}

TEST_CASE("Without forces the momentum changes by dM/dt u - c, with M differentiated along the motion") {
    Random random(4);
    constexpr double step_s = 1e-5;
    for (int i = 0; i < 100; ++i) {
        const PlantModel model = RandomPlant(random).model;
        const Four q = random_four(random, 3);
        const Four u = random_four(random, 3);
        Four after = q;
        Four before = q;
        for (std::size_t k = 0; k < 4; ++k) {
            after[k] += step_s * u[k];
            before[k] -= step_s * u[k];
        }
        const Four p_after = momentum_at(model, after, u);
        const Four p_before = momentum_at(model, before, u);
        const auto motion = dynamics::motion_at(model, q.data(), u.data());
        Four rate{};
        dynamics::free_momentum_rate(model, motion.attitude, motion.equations, u.data(), rate.data());
        for (std::size_t k = 0; k < 4; ++k) {
            const double mass_rate_times_u = (p_after[k] - p_before[k]) / (2 * step_s);
            CHECK(rate[k] == Approx(mass_rate_times_u - motion.equations.bias[k]).margin(1e-6));
        }
    }
}
