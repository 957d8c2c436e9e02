#include <catch2/catch.hpp>

#include "../support/count_allocations.hpp"
#include "downwash/aeromap/aero_map.hpp"
#include "scenes.hpp"

using namespace downwash;
using test::allocations;

TEST_CASE("Neither the direct effect nor a look-up in a filled block allocates") {
    test::Random random(41);
    const auto effect = test::effect_in(test::bridge(), 0.15);
    const AeroMap map(test::layers(effect, {0}), {}, {-1, 1, 3, 5});
    map.fill();
    const long before = allocations;
    double sum = 0;
    for (int i = 0; i < 20000; ++i) {
        const double x = random.uniform(-12, 12);
        const double z = random.uniform(0, 12);
        sum += effect->factor({x, random.uniform(-1, 1), z}) + map.factor(0, random.uniform(-1, 1), z);
    }
    const long made = allocations - before;
    CHECK(made == 0);
    CHECK(sum > 40000);
}

TEST_CASE("The effect of a vehicle's images does not allocate") {
    test::Random random(43);
    AeroSettings settings;
    settings.ground = EffectModel::multirotor_images;
    const DirectEffect effect(test::scene_of(test::bridge()), settings, 0.15, square_quadrotor(2.6));
    const long before = allocations;
    double sum = 0;
    for (int i = 0; i < 10000; ++i) {
        sum += effect.factor({random.uniform(-12, 12), random.uniform(-1, 1), random.uniform(0, 12)});
    }
    const long made = allocations - before;
    CHECK(made == 0);
    CHECK(sum > 10000);
}
