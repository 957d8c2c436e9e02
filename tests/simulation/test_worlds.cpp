#include <catch2/catch.hpp>
#include <cmath>

#include "../support/same_bytes.hpp"
#include "downwash/dynamics/rigid_body.hpp"
#include "downwash/simulation/direct_field.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/surroundings.hpp"
#include "downwash/simulation/world_tick.hpp"
#include "world_scenes.hpp"

// Flights where plant, surfaces, sensors and air are not what the controller believes.

using namespace downwash;
using namespace downwash::test;

TEST_CASE("The world without any difference is the nominal one, to the last bit") {
    Robot robot = test_robot();
    robot.rotors.time_constant_s = GENERATE(0.0, 0.02);
    const Problem problem = problem_with(robot);
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    const FlownWorld nominal = make_world(robot, {});
    FlightState plain = model->state_at({0, 2, 0, 0.4});
    FlightState other = plain;
    const ReferenceSegment segment(at_rest({0, 2, 0.4}), at_rest({1.5, 2.5, 1}), 300, model->tick().tick_s);
    const SegmentFlight a = fly(*model, map.get(), rules_of(problem), segment, plain);
    const SegmentFlight b = fly(*model, map.get(), rules_of(problem), segment, other, {&nominal, 0});
    REQUIRE(a.rejection == Rejection::none);
    CHECK(a.ticks == b.ticks);
    CHECK(std::memcmp(&plain.plant, &other.plant, sizeof plain.plant) == 0);
    CHECK(std::memcmp(&plain.memory, &other.memory, sizeof plain.memory) == 0);
}

TEST_CASE("Flights in worlds side by side are those of each alone, to the last bit, on any instructions and threads") {
    const bool is_aware = GENERATE(true, false);
    const Problem problem = problem_with(GENERATE(real_robot(), late_in_wash(), very_late()));
    const bool are_all_nominal = GENERATE(false, true);
    const auto model = make_flight_model(problem);
    const auto map = is_aware ? model->make_map(problem.bounds) : nullptr;
    Random random(3);
    std::vector<FlownWorld> worlds;
    for (int i = 0; i < 40; ++i) {
        worlds.push_back(make_world(problem.robot, random_world(random)));
    }
    std::vector<FlightJob> jobs;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        const Configuration from{random.uniform(-1.5, 3), random.uniform(0.8, 4.5), random.uniform(-1, 2)};
        const Configuration middle{from[plane::x] + random.uniform(-1, 1), from[plane::z] + random.uniform(-0.5, 0.5),
                                   0.5};
        FlightJob job{model->state_at(level_at(from)), {}};
        job.legs.push_back({{at_rest(from), at_rest(middle), random.integer(200, 400), model->tick().tick_s}});
        job.legs.push_back({{at_rest(middle), at_rest(from), random.integer(200, 400), model->tick().tick_s}});
        job.world = are_all_nominal || i % 8 == 0 ? nullptr : &worlds[i];
        job.first_tick = random.integer(0, 1000);
        if (job.world != nullptr) {
            job.start.world = memory_at_start(*job.world, job.start.plant);
        }
        jobs.push_back(std::move(job));
    }
    FlightRules rules = rules_of(problem);
    rules.max_tracking_error_m = 0.8;
    std::vector<FlightJob> expected = jobs;
    fly_one_by_one(*model, map.get(), rules, expected);
    int accepted = 0;
    for (const FlightJob& job : expected) {
        accepted += job.rejection() == Rejection::none ? 1 : 0;
    }
    CHECK(accepted > 5);
    CHECK(accepted < 40);
    for (const Instructions instructions : known_instructions()) {
        for (const int threads : {1, 3}) {
            std::vector<FlightJob> flown = jobs;
            FlightPool(*model, map.get(), rules, nullptr, threads, instructions).fly(flown);
            for (std::size_t i = 0; i < jobs.size(); ++i) {
                INFO("job " << i << " with instructions " << static_cast<int>(instructions));
                REQUIRE(flown[i].rejection() == expected[i].rejection());
                for (std::size_t leg = 0; leg < jobs[i].legs.size(); ++leg) {
                    REQUIRE(is_same(flown[i].legs[leg], expected[i].legs[leg]));
                }
            }
        }
    }
}

TEST_CASE("Bodies fall through air to the speed at which drag carries their weight") {
    Robot robot = test_robot();
    robot.multirotor.drag = {2.0, 0.5};
    robot.arm.drag = {0.5, 0.3};
    const PlantModel plant = plant_of(robot);
    dynamics::PlantState<double> state{};
    state.q[3] = 0;  // level: the whole arm is in the stream
    // Both forces act where they act; a torque in the joint and no rotation at all keep the vehicle level.
    const double fall_m_s[4] = {0, -3, 0, 0};
    const auto motion = dynamics::motion_at(plant, state.q, fall_m_s);
    double force[4] = {};
    dynamics::add_drag<double>(plant, motion.attitude, fall_m_s, {0, 0}, force);
    CHECK(force[0] == Approx(0).margin(1e-12));
    CHECK(force[1] == Approx((2.0 + 0.5 * 3) * 3 + (0.5 + 0.3 * 3) * 3));
    CHECK(force[3] == Approx(-(0.5 + 0.3 * 3) * 3 * 0.6));  // half way along the arm; up is negative
    CHECK(force[2] == Approx(force[3]));                    // the joint is at the centre of mass
    // A wind as fast as the fall makes the same air.
    double in_wind[4] = {};
    const double still[4] = {};
    dynamics::add_drag<double>(plant, motion.attitude, still, {0, 3}, in_wind);
    for (int i = 0; i < 4; ++i) {
        CHECK(in_wind[i] == Approx(force[i]).margin(1e-12));
    }
}

TEST_CASE("The drag of an arm that swings is the integral along it") {
    Robot robot = test_robot();
    robot.arm.drag = {0.4, 0.2};
    robot.arm.joint_x_m = 0.1;
    robot.arm.joint_z_m = -0.05;
    const PlantModel plant = plant_of(robot);
    Random random(5);
    for (int n = 0; n < 20; ++n) {
        const double q[4] = {0, 0, random.uniform(-0.5, 0.5), random.uniform(-3, 3)};
        // Turning about the joint faster than anything else moves: the stream crosses all of the arm from one side.
        const double u[4] = {0, 0, random.uniform(1, 2), random.uniform(1, 2)};
        const auto a = dynamics::attitude(plant, q[2], q[3]);
        double force[4] = {};
        dynamics::add_drag<double>(plant, a, u, {0, 0}, force);
        double expected[4] = {};
        constexpr int pieces = 200000;
        const double joint_m_s[2] = {u[2] * a.joint_z, -u[2] * a.joint_x};
        bool is_one_sided = true;
        for (int i = 0; i < pieces; ++i) {
            const double s = (i + 0.5) / pieces * robot.arm.length_m;
            const double v[2] = {joint_m_s[0] + (u[2] + u[3]) * s * a.arm_z,
                                 joint_m_s[1] - (u[2] + u[3]) * s * a.arm_x};
            const double across = v[0] * a.arm_z - v[1] * a.arm_x;
            is_one_sided = is_one_sided && across > 0;
            const double f = -(0.4 + 0.2 * std::abs(across)) * across / pieces;
            expected[0] += f * a.arm_z;
            expected[1] -= f * a.arm_x;
            expected[2] += f * ((a.joint_z + s * a.arm_z) * a.arm_z + (a.joint_x + s * a.arm_x) * a.arm_x);
            expected[3] += f * s;
        }
        for (int i = 0; i < 4; ++i) {
            CHECK(force[i] == Approx(expected[i]).epsilon(is_one_sided ? 1e-8 : 0.02).margin(1e-10));
        }
        // It takes from the motion what it should: power is force times speed, and never positive.
        CHECK(force[2] * u[2] + force[3] * u[3] < 0);
    }
}

TEST_CASE("A steady wind is leant against") {
    Robot robot = test_robot();
    robot.multirotor.drag = {1.5, 0.05};
    World windy;
    windy.wind_x_m_s = 2;
    Hover hover(robot, windy, {0, 2, quarter_turn});
    hover.fly(6000);
    const double push_n = (1.5 + 0.05 * 2) * 2;
    CHECK(std::tan(hover.state.plant.q[2]) == Approx(-push_n / (4.95 * standard_gravity_m_s2)).epsilon(0.02));
    CHECK(hover.state.plant.q[0] == Approx(0).margin(0.01));
}

TEST_CASE("A bias moves the vehicle by as much the other way, and heavier or weaker ones hover with more command") {
    World world;
    world.position_bias_x_m = 0.03;
    world.position_bias_z_m = -0.02;
    Hover biased(test_robot(), world, {0, 2, quarter_turn});
    biased.fly(4000);
    CHECK(biased.state.plant.q[0] == Approx(-0.03).margin(1e-4));
    CHECK(biased.state.plant.q[1] == Approx(2.02).margin(1e-4));

    World weak;
    weak.thrust_scale = -0.05;
    weak.mass_scale = 0.04;
    Robot lagging = test_robot();
    lagging.rotors.time_constant_s = 0.02;
    Hover heavy(lagging, weak, {0, 2, quarter_turn});
    heavy.fly(6000);
    double sum_n = 0;
    for (int i = 0; i < 4; ++i) {
        sum_n += heavy.state.plant.thrust_n[i];
    }
    CHECK(sum_n == Approx((4.5 * 1.04 + 0.45) * standard_gravity_m_s2 / 0.95).epsilon(1e-3));
    CHECK(heavy.state.plant.q[1] == Approx(2).margin(0.01));
}

TEST_CASE("Surfaces of a world act where they really are, each side by its own scale") {
    const Problem problem = ceiling_problem();
    const auto model = make_flight_model(problem);
    World world;
    world.ceiling_scale = 0.2;
    world.ground_scale = -0.1;
    world.scene_x_m = 0.03;
    world.scene_z_m = -0.04;
    const FlownWorld flown = make_world(problem.robot, world);
    simulation::DirectField field(*model);
    const simulation::WorldSurroundings<double, simulation::DirectField> around(flown.numbers, {}, field,
                                                                                model->tick().tilt_loss);
    Random random(8);
    double greatest = 0;
    for (int n = 0; n < 200; ++n) {
        const double x_m = random.uniform(-2, 4);
        const double z_m = random.uniform(0.3, 4.8);
        const auto sides =
            model->effect(0).factors(model->plane().to_world(x_m - 0.03, model->rotor_lateral_m(0), z_m + 0.04));
        if (sides.total != 1 + (sides.ground - 1) + (sides.ceiling - 1)) {
            continue;  // at its cap
        }
        const double expected = 1 + 0.9 * (sides.ground - 1) + 1.2 * (sides.ceiling - 1);
        CHECK(around.thrust_ratio(0, {x_m, z_m}, 0.0) == Approx(expected).epsilon(1e-12));
        greatest = std::max(greatest, std::abs(expected - sides.total));
    }
    CHECK(greatest > 0.01);
    // What touches nothing where it is believed to be may touch where it is.
    CHECK(among_obstacles({1, 2, 0.1, 0.2}, &flown).x_m == Approx(0.97));
    CHECK(among_obstacles({1, 2, 0.1, 0.2}, &flown).z_m == Approx(2.04));
}

TEST_CASE("A fountain pushes from the ground alone, whatever is above") {
    Problem problem = ceiling_problem();
    problem.aero.ground = EffectModel::multirotor_body;
    const auto model = make_flight_model(problem);
    REQUIRE(model->tick().plant.has_fountain);
    World world;
    world.ceiling_scale = 0.5;
    world.ground_scale = -0.1;
    const FlownWorld flown = make_world(problem.robot, world);
    simulation::DirectField field(*model);
    const simulation::WorldSurroundings<double, simulation::DirectField> around(flown.numbers, {}, field,
                                                                                model->tick().tilt_loss);
    for (const double z_m : {0.4, 1.0, 4.6}) {  // the last one close below the ceiling
        const double push = field.at_body(0, z_m).all - 1;
        CHECK(around.body_ratio({0, z_m}, 0.0) == Approx(1 + 0.9 * push).epsilon(1e-12));
    }
    CHECK(field.at_body(0, 0.4).all != 1);
}

TEST_CASE("Walls are where a world has them, and as strong as in the nominal world whatever it does to K") {
    Problem problem = ceiling_problem();
    problem.obstacles = {{"wall", Box{{1, 40, 10}}, {1.5, 0, 2}, {}}};
    problem.aero.wall = {0.02, 0.04, 1};
    const auto model = make_flight_model(problem);
    World world;
    world.ceiling_scale = 0.5;
    world.ground_scale = -0.3;
    world.scene_x_m = 0.1;
    const FlownWorld flown = make_world(problem.robot, world);
    simulation::DirectField field(*model);
    const simulation::WorldSurroundings<double, simulation::DirectField> around(flown.numbers, {}, field,
                                                                                model->tick().tilt_loss);
    const double nearness = field.wall_nearness(0.2, 2);
    CHECK(nearness > 0.2);
    CHECK(around.wall_nearness({0.3, 2.0}) == Approx(nearness).epsilon(1e-9));
}
