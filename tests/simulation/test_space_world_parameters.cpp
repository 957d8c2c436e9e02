#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <thread>

#include "../support/space_robots.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

// The table of what worlds in space draw.

using namespace downwash;
using namespace downwash::test;

namespace {

bool same_worlds(const SpaceWorld& a, const SpaceWorld& b) {
    return a.tape == b.tape && a.gust_m_s == b.gust_m_s && a.position_noise_m == b.position_noise_m &&
           std::ranges::all_of(space_world_parameters(),
                               [&](const SpaceWorldParameter& each) { return each.of(a) == each.of(b); });
}

}  // namespace

TEST_CASE(
    "Every key of worlds in space is a noise or draws numbers, and every number has a key and a place of its own") {
    std::set<std::string> paths;
    for (const UncertaintyKey& key : space_uncertainty_keys()) {
        CAPTURE(key.path);
        CHECK(paths.insert(std::string(key.path)).second);
        if (key.spread == nullptr) {
            continue;  // a group
        }
        const auto drawn = std::ranges::count(space_world_parameters(), key.spread, &SpaceWorldParameter::spread);
        CHECK((key.noise != nullptr) == (drawn == 0));
    }
    std::set<std::string> names;
    for (const SpaceWorldParameter& parameter : space_world_parameters()) {
        CAPTURE(parameter.name);
        CHECK(names.insert(parameter.name).second);
        CHECK(paths.count(parameter.name.substr(0, parameter.name.find(' '))) == 1);
        // It changes its own number and no other.
        SpaceWorld world;
        parameter.place(world, parameter.number) = 0.25;
        for (const SpaceWorldParameter& other : space_world_parameters()) {
            CHECK(other.of(world) == (other.name == parameter.name ? 0.25 : 0));
        }
    }
}

TEST_CASE("Worlds in space are the same for a seed and an index, on any thread, and world 0 is nominal") {
    const SpaceRobot robot = space_robot(2);
    const Uncertainty uncertainty;
    const SpaceWorld nominal = draw_space_world(uncertainty, robot, 7, 0);
    CHECK(same_worlds(nominal, SpaceWorld{}));
    CHECK(nominal.gust_m_s == 0);
    SpaceWorld here[50], there[50];
    for (std::uint64_t i = 0; i < 50; ++i) {
        here[i] = draw_space_world(uncertainty, robot, 7, i);
    }
    std::thread other([&] {
        for (std::uint64_t i = 50; i-- > 0;) {
            there[i] = draw_space_world(uncertainty, robot, 7, i);
        }
    });
    other.join();
    for (int i = 0; i < 50; ++i) {
        CHECK(same_worlds(here[i], there[i]));
        CHECK((i == 0 || !same_worlds(here[i], here[i - 1])));
    }
    CHECK_FALSE(same_worlds(here[3], draw_space_world(uncertainty, robot, 8, 3)));
}

TEST_CASE("No world in space of a seed is a world of another seed") {
    const SpaceRobot robot = space_robot(1);
    constexpr std::uint64_t seeds = 32, indices = 64;
    std::set<std::uint64_t> tapes;
    std::set<double> masses;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        for (std::uint64_t index = 1; index < indices; ++index) {
            const SpaceWorld world = draw_space_world({}, robot, seed, index);
            tapes.insert(world.tape);
            masses.insert(world.mass_scale);
        }
    }
    CHECK(tapes.size() == seeds * (indices - 1));
    CHECK(masses.size() == seeds * (indices - 1));
}

TEST_CASE("A joint more does not change what a world draws for everything else") {
    const Uncertainty uncertainty;
    const SpaceWorld two = draw_space_world(uncertainty, space_robot(2), 3, 5);
    const SpaceWorld three = draw_space_world(uncertainty, space_robot(3), 3, 5);
    for (const SpaceWorldParameter& parameter : space_world_parameters()) {
        CAPTURE(parameter.name);
        const bool is_new = parameter.name.ends_with(" 3") && !parameter.name.starts_with("vehicle.rotor");
        CHECK((parameter.of(two) == parameter.of(three)) == !is_new);
    }
}

TEST_CASE("Numbers of worlds in space are spread as their keys say") {
    const SpaceRobot robot = space_robot(1);
    Uncertainty uncertainty;
    uncertainty.joint_offset_rad = Spread::over(0.01, 0.03);
    constexpr int worlds = 4000;
    double mass = 0, roll = 0, least = 1, most = -1, least_lag = 1, most_lag = -1;
    double between = 0;
    for (std::uint64_t i = 1; i <= worlds; ++i) {
        const SpaceWorld world = draw_space_world(uncertainty, robot, 2, i);
        mass += world.mass_scale * world.mass_scale / worlds;
        roll += world.attitude_bias_rad[0] * world.attitude_bias_rad[0] / worlds;
        between += world.attitude_bias_rad[0] * world.attitude_bias_rad[1] / worlds;
        least = std::min(least, world.joint_offset_rad[0]);
        most = std::max(most, world.joint_offset_rad[0]);
        least_lag = std::min(least_lag, world.rotor_time_constant_s);
        most_lag = std::max(most_lag, world.rotor_time_constant_s);
        CHECK(world.joint_offset_rad[1] == 0);    // no such joint
        CHECK(world.rotor_thrust_scale[6] == 0);  // no such rotor
        CHECK(world.wash_scale == 0);             // no wash
    }
    const double sd_rad = uncertainty.pitch_bias_rad.high;
    CHECK(std::sqrt(mass) == Approx(0.02).epsilon(0.05));  // cut at 3 sd: 1.3 % less
    CHECK(std::sqrt(roll) == Approx(sd_rad).epsilon(0.05));
    CHECK(std::abs(between) < 0.08 * sd_rad * sd_rad);
    CHECK(least > 0.01);
    CHECK(least < 0.0101);
    CHECK(most < 0.03);
    CHECK(most > 0.0299);
    CHECK(least_lag == Approx(-0.3 * 0.03).epsilon(0.01));
    CHECK(most_lag == Approx(0.5 * 0.03).epsilon(0.01));
}
