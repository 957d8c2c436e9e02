#include <catch2/catch.hpp>
#include <cmath>

#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"

using namespace downwash;

namespace {

const auto no_obstacles = std::make_shared<const Scene>(std::vector<Obstacle>{});

RotorParameters rotors_at(std::vector<Vector3> hubs_m) {
    RotorParameters rotors;
    rotors.radius_m = 0.15;
    rotors.positions_m = std::move(hubs_m);
    return rotors;
}

}  // namespace

TEST_CASE("Rotors share a layer when lateral offset and effect agree") {
    const RotorParameters quadrotor = rotors_at({{0.3, 0.3, 0}, {0.3, -0.3, 0}, {-0.3, 0.3, 0}, {-0.3, -0.3, 0}});
    AeroSettings aero;
    CHECK(effect_layers(quadrotor, no_obstacles, aero).of_rotor == std::vector<std::size_t>{0, 1, 0, 1});
    // Each rotor has its neighbours elsewhere.
    aero.ground = EffectModel::multirotor_images;
    CHECK(effect_layers(quadrotor, no_obstacles, aero).of_rotor == std::vector<std::size_t>{0, 1, 2, 3});
    aero.ground = EffectModel::multirotor_body;
    const EffectLayers with_body = effect_layers(quadrotor, no_obstacles, aero);
    CHECK(with_body.of_rotor == std::vector<std::size_t>{0, 1, 2, 3});
    REQUIRE(with_body.of_body == 4);
    CHECK(with_body.layers[4].lateral_m == 0);

    const RotorParameters row = rotors_at({{-0.4, 0, 0}, {0, 0, 0}, {0.4, 0, 0}});
    aero.ground = EffectModel::cheeseman_bennett;
    CHECK(effect_layers(row, no_obstacles, aero).of_rotor == std::vector<std::size_t>{0, 0, 0});
    aero.ground = EffectModel::multirotor_images;
    CHECK(effect_layers(row, no_obstacles, aero).of_rotor == std::vector<std::size_t>{0, 1, 2});
}

TEST_CASE("The map of the fountain is within 0.01 of the direct effect, inside obstacles too") {
    Problem problem = test::ceiling_problem();
    problem.obstacles = {{"floor", Box{{40, 40, 1}}, {0, 0, -0.5}, {}},
                         {"step", Box{{1.2, 3, 0.5}}, {1, 0.4, 0.25}, {}}};
    problem.aero.ground = EffectModel::multirotor_body;
    problem.bounds = {-1, 3, 0.1, 2};
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    const std::size_t layer = model->body_layer();
    double worst = 0;
    for (int i = 0; i < 150; ++i) {
        for (int k = 0; k < 150; ++k) {
            const double x = -1 + 4 * (i + 0.37) / 150;
            const double z = 0.05 + 1.9 * (k + 0.61) / 150;
            worst = std::max(worst, std::abs(map->factor(layer, x, z) - model->factor_in_layer(layer, x, z).all));
            REQUIRE(map->is_flyable(layer, x, z));
        }
    }
    CHECK(worst <= 0.01);
}
