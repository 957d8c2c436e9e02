#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "../support/washed_robot.hpp"
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
        CHECK((drawn > 0 || key.noise != nullptr) == (key.spread != nullptr));
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

TEST_CASE("what displaces a vehicle beside its plane is drawn last, from its own spread, and changes nothing else") {
    Uncertainty in_plane;
    in_plane.scene_y_m = in_plane.wind_y_m_s = in_plane.lateral_error_m = {};
    std::vector<std::string> lateral;
    for (const WorldParameter& parameter : world_parameters()) {
        if (parameter.is_lateral) {
            lateral.push_back(parameter.name);
        } else {
            CHECK(lateral.empty());
        }
    }
    CHECK(lateral == std::vector<std::string>{"aero.scene_offset_m.y", "sensing.position_bias_m y",
                                              "vehicle.lateral_error_m", "wind.steady_m_s.y", "wind.gust_m_s y"});
    double squares = 0;
    for (std::uint64_t index = 1; index <= 400; ++index) {
        const World all = draw_world(Uncertainty{}, late_robot(), 1, index);
        const World some = draw_world(in_plane, late_robot(), 1, index);
        for (const WorldParameter& each : world_parameters()) {
            const bool is_exact = each.is_lateral && (in_plane.*each.spread).form == Spread::Form::exact;
            CHECK(each.of(some) == (is_exact ? 0 : each.of(all)));
        }
        squares += all.gust_y_m_s * all.gust_y_m_s;
    }
    CHECK(std::sqrt(squares / 400) == Approx(0.3).epsilon(0.1));  // as strong as the gusts of every tick
}

TEST_CASE("only a robot with a wash draws how fast it is, and all else of its worlds is as without one") {
    Robot washed = late_robot();
    washed.arm.drag = {0, 0.05};
    washed.arm.wash.emplace();
    CHECK(world_parameters_of(washed).size() == world_parameters().size());
    CHECK(world_parameters_of(late_robot()).size() + 1 == world_parameters().size());
    double sum = 0;
    for (std::uint64_t index = 1; index <= 20; ++index) {
        const World with = draw_world(Uncertainty{}, washed, 1, index);
        const World without = draw_world(Uncertainty{}, late_robot(), 1, index);
        CHECK(without.arm_wash_scale == 0);
        CHECK(with.arm_wash_scale != 0);
        CHECK(with.tape == without.tape);
        for (const WorldParameter* each : world_parameters_of(late_robot())) {
            CHECK(each->of(with) == each->of(without));
        }
        sum += std::abs(with.arm_wash_scale);
    }
    CHECK(sum / 20 == Approx(0.12).margin(0.05));  // of a normal number with the sd 0.15
}
