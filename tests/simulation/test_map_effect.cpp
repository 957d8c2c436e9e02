#include <catch2/catch.hpp>

#include "../support/random.hpp"
#include "../support/test_problem.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/map_effect.hpp"

using namespace downwash;

namespace {

/// A vehicle with two rotors beside each other at either end, under a ceiling that ends on the left of the plane from
/// x = 0 on: before that, both sides feel the same.
Problem half_a_ceiling() {
    Problem problem = test::ceiling_problem();
    problem.obstacles = {{"floor", Box{{40, 40, 1}}, {0, 0, -0.5}, {}},
                         {"ceiling", Box{{10, 10, 1}}, {-5, 0, 3.5}, {}},
                         {"right half", Box{{10, 5, 1}}, {5, -2.5, 3.5}, {}}};
    problem.robot.rotors.positions_m = {{-0.3, 0.2, 0}, {-0.3, -0.2, 0}, {0.3, 0.2, 0}, {0.3, -0.2, 0}};
    problem.bounds = {-4, 4, 0.5, 3};
    return problem;
}

}  // namespace

TEST_CASE("rotors beside each other share a look-up where both feel the same, and only there") {
    const Problem problem = half_a_ceiling();
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    const simulation::RotorMaps maps = simulation::rotor_maps(*model, *map);
    simulation::MapEffect<double> effect(maps);
    simulation::FlightEffectOf any(effect);
    REQUIRE(model->rotor_layer(0) != model->rotor_layer(1));
    test::Random random(7);
    int together = 0;
    int apart = 0;
    double x_m = 0;
    double z_m = 2;
    const auto step = [&random](double& at_m, double low_m, double high_m) {
        at_m = std::clamp(at_m + random.uniform(-0.1, 0.1), low_m, high_m);
    };
    for (int i = 0; i < 20000; ++i) {
        step(x_m, -4.8, 4.8);  // beyond the map, too
        step(z_m, 0.6, 2.8);
        for (const int first : {0, 2}) {
            const int second = first + 1;
            const double hub_m = x_m + (first == 0 ? -0.3 : 0.3);
            const auto expected = [&](int rotor) { return map->sided_factor(model->rotor_layer(rotor), hub_m, z_m); };
            const SidedFactor<double> k = effect.at_rotor(first, hub_m, z_m);
            REQUIRE(k.all == expected(first).all);
            REQUIRE(k.above == expected(first).above);
            REQUIRE(any.at_rotor(first, hub_m, z_m).all == k.all);
            REQUIRE(any.same_as(second) == effect.same_as(second));
            if (effect.same_as(second) == first) {
                REQUIRE(expected(second).all == k.all);
                REQUIRE(expected(second).above == k.above);
                ++together;
            } else {
                REQUIRE(effect.same_as(second) == second);
                REQUIRE(effect.at_rotor(second, hub_m, z_m).all == expected(second).all);
                ++apart;
            }
            CHECK(effect.same_as(first) == first);
        }
    }
    CHECK(together > 4000);
    CHECK(apart > 4000);
}

TEST_CASE("no look-up is shared beyond the map, nor by rotors that are one behind the other") {
    const Problem problem = half_a_ceiling();
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    const simulation::RotorMaps maps = simulation::rotor_maps(*model, *map);
    simulation::MapEffect<double> effect(maps);
    static_cast<void>(effect.at_rotor(0, -30, 2));
    CHECK(effect.same_as(1) == 1);
    static_cast<void>(effect.at_rotor(0, -3, 2));
    CHECK(effect.same_as(1) == 0);
    CHECK(effect.same_as(2) == 2);
}
