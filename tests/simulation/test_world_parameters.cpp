#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "../support/test_robot.hpp"
#include "downwash/simulation/world_parameters.hpp"

// The table of what worlds draw.

using namespace downwash;

namespace {

/// A robot whose lag and delay can be multiplied by something.
Robot late_robot() {
    Robot robot = test::test_robot();
    robot.rotors.time_constant_s = 0.02;
    robot.controller.delay_s = 0.01;
    return robot;
}

}  // namespace

TEST_CASE("every uncertainty has one key, and is either drawn for a world or a noise of every tick") {
    std::set<std::string_view> paths;
    for (const UncertaintyKey& key : uncertainty_keys()) {
        CAPTURE(key.path);
        CHECK(paths.insert(key.path).second);
        const auto drawn = std::ranges::count(world_parameters(), key.spread, &WorldParameter::spread);
        CHECK((drawn > 0) == (key.spread != nullptr && key.noise == nullptr));
        for (const WorldParameter& parameter : world_parameters()) {
            CHECK((parameter.spread != key.spread || parameter.name.starts_with(key.path)));
        }
    }
}

TEST_CASE("a parameter of the worlds changes the number that it stands for, and no other") {
    std::set<std::string> names;
    for (const WorldParameter& parameter : world_parameters()) {
        CAPTURE(parameter.name);
        CHECK(names.insert(parameter.name).second);
        World world;
        parameter.put(world, Uncertainty{}, late_robot(), 0.9);
        for (const WorldParameter& other : world_parameters()) {
            CHECK((other.of(world) != 0) == (&other == &parameter));
        }
    }
}

TEST_CASE("worlds differ in what they draw, noise and gusts have one size in all of them, and world 0 is nominal") {
    const World first = draw_world(Uncertainty{}, late_robot(), 1, 1);
    const World second = draw_world(Uncertainty{}, late_robot(), 1, 2);
    CHECK(first.ceiling_scale != second.ceiling_scale);
    CHECK(first.tape != second.tape);
    for (const World& world : {first, second}) {
        CHECK(world.position_noise_m == 0.005);
        CHECK(world.velocity_noise_m_s == 0.02);
        CHECK(world.gyro_noise_rad_s == 0.015);
        CHECK(world.gust_m_s == 0.3);
        CHECK(world.gust_length_x_m == 23);
        CHECK(world.gust_length_z_m == 3);
    }
    const World nominal = draw_world(Uncertainty{}, late_robot(), 1, 0);
    CHECK(std::ranges::all_of(world_parameters(), [&](const WorldParameter& each) { return each.of(nominal) == 0; }));
    CHECK(nominal.gust_m_s == 0);
}
