#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "../support/same_bytes.hpp"
#include "downwash/simulation/execution.hpp"
#include "world_scenes.hpp"

// Vehicles beside their plane of motion.

using namespace downwash;
using namespace downwash::test;

TEST_CASE(
    "A vehicle is beside its plane by what its sensors, its loop and the air do, and the obstacles are where they "
    "are") {
    Robot robot = test_robot();
    robot.multirotor.drag = {1.5, 0.05};
    robot.arm.drag = {0, 0.1};
    World world;
    CHECK(make_world(robot, world).lateral_m == 0);
    world.scene_y_m = 0.02;
    world.position_bias_y_m = -0.03;
    world.lateral_error_m = 0.005;
    CHECK(make_world(robot, world).lateral_m == Approx(0.015));
    CHECK(among_obstacles({1, 2, 0.1, 0.2}, nullptr).lateral_m == 0);
    const FlownWorld flown = make_world(robot, world);
    CHECK(among_obstacles({1, 2, 0.1, 0.2}, &flown).lateral_m == flown.lateral_m);
    CHECK(without_noise(flown).lateral_m == flown.lateral_m);

    // A gust pushes until the loop along x, turned by a right angle, would hold against it: 2 / s2 of 4.95 kg.
    world = {};
    world.gust_y_m_s = -2;
    CHECK(make_world(robot, world).lateral_m == Approx(-(1.5 + 0.15 * 2) * 2 / (4.95 * 2.0)));
    // A steady wind does so only where nothing integrates.
    world = {};
    world.wind_y_m_s = 2;
    CHECK(make_world(robot, world).lateral_m == 0);
    const double pushed_m = (1.5 + 0.15 * 2) * 2 / (4.95 * 2.0);
    gains_of(robot).position_ki = 0;
    CHECK(make_world(robot, world).lateral_m == Approx(pushed_m));
    give_aids(robot.controller.law, {controllers::DisturbanceObserver{3}, {}});
    CHECK(make_world(robot, world).lateral_m == 0);
    CascadedPid cascade;
    robot.controller.law = cascade;
    CHECK(make_world(robot, world).lateral_m == 0);
    cascade.horizontal_velocity_ki = 0;
    robot.controller.law = cascade;
    CHECK(make_world(robot, world).lateral_m == Approx(pushed_m * 2.0 / (0.75 * 1.1)));
    robot.controller.law = PlanarLyapunov{};
    CHECK(make_world(robot, world).lateral_m == Approx(pushed_m * 2.0 / (1 + 1.1 * 1.1)));
}

TEST_CASE("Flights beside a wall along their plane side by side are those of each alone, to the last bit") {
    constexpr double gap_m = 0.05;  // from the rotors to the wall
    Problem problem = problem_with(real_robot());
    problem.obstacles.push_back(box("wall", {30, 0.2, 12}, {0, 0.5105 + gap_m + 0.1, 0}));
    problem.aero.min_distance_radii = 0.1;
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    Random random(6);
    std::vector<FlownWorld> worlds;
    for (int i = 0; i < 24; ++i) {
        World world = random_world(random);
        world.lateral_error_m = i < 12 ? random.uniform(-0.1, 0.04) : random.uniform(0.03, 0.15);
        worlds.push_back(make_world(problem.robot, world));
    }
    std::vector<FlightJob> jobs;
    for (const FlownWorld& world : worlds) {
        const Configuration from{random.uniform(-1.5, 1), random.uniform(2, 3), 0.5};
        FlightJob job{model->state_at(level_at(from)), {}, 0, &world};
        job.start.world = memory_at_start(world, job.start.plant);
        job.legs.push_back({{at_rest(from), at_rest({from[plane::x] + 1, 2.5, 0.8}), 300, model->tick().tick_s}});
        jobs.push_back(std::move(job));
    }
    FlightRules rules = rules_of_execution();
    rules.finds_min_clearance = ClearanceError{0, 0};
    std::vector<FlightJob> expected = jobs;
    fly_one_by_one(*model, map.get(), rules, expected);
    int free = 0;
    int stopped = 0;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const SegmentFlight& flight = expected[i].legs[0].flight;
        const double left_m = gap_m - worlds[i].lateral_m;
        CAPTURE(i, left_m);
        CHECK(flight.rejection == (left_m > 0 ? Rejection::none : Rejection::collision));
        CHECK(std::max(0.0, flight.min_clearance_m) == Approx(std::max(0.0, left_m)).margin(1e-7));
        ++(left_m > 0 ? free : stopped);
    }
    CHECK(free > 5);
    CHECK(stopped > 5);
    for (const Instructions instructions : known_instructions()) {
        std::vector<FlightJob> flown = jobs;
        FlightPool(*model, map.get(), rules, nullptr, 2, instructions).fly(flown);
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            INFO("job " << i << " with instructions " << static_cast<int>(instructions));
            CHECK(is_same(flown[i].legs[0], expected[i].legs[0]));
            CHECK(flown[i].legs[0].flight.min_clearance_m ==
                  Approx(expected[i].legs[0].flight.min_clearance_m).margin(1e-7));
        }
    }
}
