#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "../../bench/space_oracle/twin_flights.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/world_parameters.hpp"

// A small version of bench/space_oracle.sh.

using namespace downwash;
using namespace downwash::bench;

namespace {

const std::filesystem::path problems = DOWNWASH_PROBLEMS;

}  // namespace

TEST_CASE("A plan through a culvert is flown in space as in the plane, in drawn worlds with noise and gusts") {
    const Problem problem = read_problem(problems / "culvert.yaml");  // its plane has a heading of 30 degrees
    const SpaceRobot robot = read_space_robot(problems / "robots/ars_lrm_space.yaml");
    const TwinFlights twins(problem, robot);
    const Plan plan = nominal_plan(problem, 1, 300);
    CHECK(std::abs(plan.last()[plane::x] - plan.first()[plane::x]) > 3);
    for (std::uint64_t index = 0; index < 4; ++index) {
        const World world =
            in_plane(draw_world(problem.uncertainty.value_or(Uncertainty{}), problem.robot, 1, index), problem.robot);
        CHECK((world.gust_m_s > 0) == (index > 0));
        const Apart apart = twins.fly(plan, world, 2000);
        CAPTURE(index, apart.beside_m, apart.attitude_rad, apart.joint_rad, apart.energy_j);
        REQUIRE(apart.clipped_ticks == 0);
        CHECK(apart.place_m < 1e-6);
        CHECK(apart.attitude_rad < 1e-6);
        CHECK(apart.joint_rad < 1e-6);
    }
}

TEST_CASE("Flights of robots and worlds that differ come apart") {
    const Problem problem = read_problem(problems / "open_air.yaml");
    SpaceRobot robot = read_space_robot(problems / "robots/ars_lrm_space.yaml");
    const Plan plan = nominal_plan(problem, 1, 300);
    CHECK(TwinFlights(problem, robot).fly(plan, {}, 300).place_m < 1e-9);
    World lopsided;  // a rotor on one side alone: in_plane() would not leave it so
    lopsided.rotor_thrust_scale[0] = 0.01;
    const Apart aside = TwinFlights(problem, robot).fly(plan, lopsided, 300);
    CHECK(aside.beside_m > 1e-4);
    CHECK(aside.place_m >= aside.beside_m);
    robot.plant.multirotor.mass_kg *= 1.01;
    CHECK(TwinFlights(problem, robot).fly(plan, {}, 300).place_m > 1e-6);
}

TEST_CASE("What a world has in the plane leaves out what is beside it") {
    const Problem problem = read_problem(problems / "open_air.yaml");
    World world;
    world.scene_x_m = 0.1;
    world.scene_y_m = world.position_bias_y_m = world.wind_y_m_s = world.gust_y_m_s = world.lateral_error_m = 0.2;
    const double scales[] = {0.01, 0.03, -0.02, 0.06};  // the first two rotors are ahead
    std::copy_n(scales, 4, world.rotor_thrust_scale);
    const World mine = in_plane(world, problem.robot);
    CHECK(mine.scene_x_m == 0.1);
    for (const double number :
         {mine.scene_y_m, mine.position_bias_y_m, mine.wind_y_m_s, mine.gust_y_m_s, mine.lateral_error_m}) {
        CHECK(number == 0);
    }
    CHECK(mine.rotor_thrust_scale[0] == Approx(0.02));
    CHECK(mine.rotor_thrust_scale[1] == mine.rotor_thrust_scale[0]);
    CHECK(mine.rotor_thrust_scale[2] == Approx(0.02));
    CHECK(mine.rotor_thrust_scale[3] == mine.rotor_thrust_scale[2]);
}
