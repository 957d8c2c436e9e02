#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>

#include "../support/same_bytes.hpp"
#include "../support/washed_robot.hpp"
#include "downwash/dynamics/rigid_body.hpp"
#include "downwash/simulation/direct_field.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/surroundings.hpp"
#include "downwash/simulation/world_tick.hpp"
#include "hover_scenes.hpp"

// Flights where plant, surfaces, sensors and air are not what the controller believes.

using namespace downwash;
using namespace downwash::test;

namespace {

/// Everything different, a little.
World random_world(Random& random) {
    World world;
    world.ceiling_scale = random.uniform(-0.3, 0.3);
    world.ground_scale = random.uniform(-0.3, 0.3);
    world.scene_x_m = random.uniform(-0.04, 0.04);
    world.scene_y_m = random.uniform(-0.04, 0.04);
    world.scene_z_m = random.uniform(-0.04, 0.04);
    world.mass_scale = random.uniform(-0.05, 0.05);
    world.inertia_scale = random.uniform(-0.1, 0.1);
    world.arm_mass_scale = random.uniform(-0.1, 0.1);
    world.center_of_mass_x_m = random.uniform(-0.01, 0.01);
    world.center_of_mass_z_m = random.uniform(-0.01, 0.01);
    world.thrust_scale = random.uniform(-0.05, 0.05);
    for (double& scale : world.rotor_thrust_scale) {
        scale = random.uniform(-0.02, 0.02);
    }
    world.arm_wash_scale = random.uniform(-0.3, 0.3);
    world.rotor_time_constant_s = random.uniform(-0.005, 0.01);
    world.delay_s = random.uniform(0, 0.01);
    world.position_bias_x_m = random.uniform(-0.02, 0.02);
    world.position_bias_y_m = random.uniform(-0.02, 0.02);
    world.position_bias_z_m = random.uniform(-0.02, 0.02);
    world.pitch_bias_rad = random.uniform(-0.01, 0.01);
    world.wind_x_m_s = random.uniform(-1, 1);
    world.wind_z_m_s = random.uniform(-0.3, 0.3);
    world.position_noise_m = 0.005;
    world.velocity_noise_m_s = 0.02;
    world.gyro_noise_rad_s = 0.015;
    world.gust_m_s = 0.3;
    world.gust_length_x_m = 20;
    world.gust_length_z_m = 3;
    world.tape = static_cast<std::uint64_t>(random.integer(0, 1'000'000));
    return world;
}

/// A vehicle with all that a world can change: rotors that lag, drag, and sight that is late.
Robot real_robot() {
    Robot robot = test_robot();
    robot.rotors.time_constant_s = 0.02;
    robot.controller.delay_s = 0.01;
    robot.multirotor.drag = {1.5, 0.04};
    robot.arm.drag = {0, 0.05};
    return robot;
}

/// The same with an arm below its rotors.
Robot late_in_wash() {
    Robot robot = washed_robot();
    robot.rotors.time_constant_s = 0.02;
    robot.controller.delay_s = 0.01;
    return robot;
}

/// A vehicle that sees up to three ticks late in some worlds and later in the others.
Robot very_late() {
    Robot robot = test_robot();
    robot.controller.delay_s = 0.027;
    return robot;
}

Problem problem_with(const Robot& robot) {
    Problem problem = ceiling_problem();
    problem.robot = robot;
    return problem;
}

/// The flight of a reference at one place in free air.
struct Hover {
    std::shared_ptr<const FlightModel> model;
    FlownWorld world;
    FlightState state;
    ReferencePoint reference;

    Hover(const Robot& robot, const World& in, const Configuration& at)
        : model(std::make_shared<const FlightModel>(robot, PlaneOfMotion{},
                                                    std::make_shared<const Scene>(std::vector<Obstacle>{}), no_aero())),
          world(make_world(robot, in)),
          state(model->state_at(level_at(at))),
          reference(at_rest(at)) {
        state.world = memory_at_start(world, state.plant);
    }

    static AeroSettings no_aero() {
        AeroSettings aero;
        aero.enabled = false;
        return aero;
    }

    /// @param after callable (state) after every tick
    template <class After>
    void fly(int ticks, const After& after) {
        const ReferenceSegment segment(reference, reference, ticks, model->tick().tick_s);
        simulation::FlightEffectOf calm{simulation::NoEffect{}};
        const simulation::FlightLoop loop(model->tick(), &world, calm);
        loop.fly(0, segment, state,
                 [&](const FlightState&, const ReferencePoint&, const controllers::Actuation<double>&,
                     const FlightState& next, const ReferencePoint&) {
                     after(next);
                     return Rejection::none;
                 });
    }
    void fly(int ticks) {
        fly(ticks, [](const FlightState&) {});
    }
};

}  // namespace

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

TEST_CASE("A controller sees what was a delay ago, linear between two ticks") {
    World late;
    late.delay_s = 0.015;
    const FlownWorld world = make_world(test_robot(), late);
    simulation::WorldMemory<double> memory{};
    for (int age = 0; age < simulation::recent_ticks; ++age) {
        memory.past[age].q[0] = -(age + 1.0);
        memory.past[age].u[3] = 10 * (age + 1.0);
    }
    const double no_noise[simulation::noise_count] = {};
    const auto seen = simulation::seen_state(world.numbers, {}, memory, no_noise);
    CHECK(seen.q[0] == Approx(-1.5));
    CHECK(seen.u[3] == Approx(15));

    Hover hover(test_robot(), late, {0, 2, 0});
    hover.reference.position[0] = 0.5;
    std::vector<double> x_m{hover.state.plant.q[0]};
    hover.fly(20, [&](const FlightState& state) {
        for (std::size_t age = 0; age < simulation::recent_ticks && age < x_m.size(); ++age) {
            CHECK(state.world.past[age].q[0] == x_m[x_m.size() - 1 - age]);
        }
        x_m.push_back(state.plant.q[0]);
    });
    CHECK(x_m.back() > 1e-3);
}

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

TEST_CASE("a controller that sees many ticks late remembers so many, and no others do") {
    World late;
    late.delay_s = 0.125;
    Hover hover(test_robot(), late, {0, 2, 0});
    CHECK(hover.state.world.older.empty());  // it was always there
    hover.reference.position[0] = 0.5;
    const double no_noise[simulation::noise_count] = {};
    std::vector<double> x_m{hover.state.plant.q[0]};
    hover.fly(30, [&](const FlightState& state) {
        CHECK(state.world.older.size() == 13 - simulation::recent_ticks);
        x_m.push_back(state.plant.q[0]);
        const auto ago = [&](std::size_t ticks) { return ticks < x_m.size() ? x_m[x_m.size() - 1 - ticks] : x_m[0]; };
        const auto seen = simulation::seen_state(hover.world.numbers, state.plant, state.world, no_noise);
        CHECK(seen.q[0] == Approx(0.5 * (ago(12) + ago(13))).margin(1e-15));
        for (int age = 1; age <= 13; ++age) {
            CHECK(simulation::past_at(state.world, age).q[0] == ago(static_cast<std::size_t>(age)));
        }
    });
    CHECK(x_m.back() > 1e-3);

    late.delay_s = 0.03 * (1 + 1e-12);  // three ticks but for rounding
    Hover soon(test_robot(), late, {0, 2, 0});
    soon.fly(5);
    CHECK(soon.world.numbers.delay_ticks == Approx(3));
    CHECK(soon.state.world.older.empty());
    FlightState other = soon.state;
    CHECK(is_same(other, soon.state));
    other.world.older.assign(1, other.world.past[simulation::recent_ticks - 1]);
    CHECK(is_same(other, soon.state));
    other.world.older[0].q[0] += 1;
    CHECK_FALSE(is_same(other, soon.state));
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

TEST_CASE("Noise is standard normal, white, and the same for a tape and a tick") {
    constexpr int ticks = 40000;
    double sum[simulation::noise_count] = {}, squares[simulation::noise_count] = {}, fourth = 0;
    double with_next = 0, across = 0, between_tapes = 0;
    double before[simulation::noise_count] = {};
    for (int tick = 0; tick < ticks; ++tick) {
        double noise[simulation::noise_count], other[simulation::noise_count];
        simulation::draw_noise(simulation::normal_levels(), 77, tick, noise, 1);
        simulation::draw_noise(simulation::normal_levels(), 78, tick, other, 1);
        for (int i = 0; i < simulation::noise_count; ++i) {
            sum[i] += noise[i];
            squares[i] += noise[i] * noise[i];
            fourth += std::pow(noise[i], 4) / simulation::noise_count;
            with_next += noise[i] * before[i] / simulation::noise_count;
            between_tapes += noise[i] * other[i] / simulation::noise_count;
            before[i] = noise[i];
        }
        across += noise[0] * noise[1] + noise[3] * noise[4] + noise[6] * noise[7];
    }
    const double slack = 4 / std::sqrt(ticks);  // four standard deviations of a mean
    for (int i = 0; i < simulation::noise_count; ++i) {
        CHECK(std::abs(sum[i] / ticks) < slack);
        CHECK(std::abs(squares[i] / ticks - 1) < std::sqrt(2.0) * slack);
    }
    CHECK(fourth / ticks == Approx(3).margin(0.1));
    CHECK(std::abs(with_next / ticks) < slack);
    CHECK(std::abs(between_tapes / ticks) < slack);
    CHECK(std::abs(across / ticks) < 2 * slack);
    double again[simulation::noise_count];
    simulation::draw_noise(simulation::normal_levels(), 77, ticks - 1, again, 1);
    CHECK(std::memcmp(again, before, sizeof again) == 0);
}

TEST_CASE("Gusts have the variance and the spectrum of the Dryden model") {
    World world;
    world.gust_m_s = 0.4;
    world.gust_length_x_m = 2;
    world.gust_length_z_m = 1;
    world.wind_x_m_s = 2.5;
    const FlownWorld flown = make_world(test_robot(), world);
    constexpr double tick_s = 0.01, speed_m_s = 2.5;
    constexpr int length = 4096;
    constexpr int pieces = 150;
    // Angular frequencies around the corners at V / L = 1.25 and 2.5 rad/s.
    const int bins[] = {3, 6, 12, 24, 48, 96};
    double power[2][6] = {};
    double variance[2] = {};
    for (int piece = 0; piece < pieces; ++piece) {
        FlownWorld own = flown;
        own.world.tape = static_cast<std::uint64_t>(piece);
        auto memory = memory_at_start(own, {});
        std::complex<double> sums[2][6];
        for (int tick = 0; tick < length; ++tick) {
            const auto wind = simulation::wind_in(own.numbers, memory);
            const double gust[2] = {wind.x - 2.5, wind.z};
            for (int axis = 0; axis < 2; ++axis) {
                variance[axis] += gust[axis] * gust[axis] / length / pieces;
                for (int k = 0; k < 6; ++k) {
                    sums[axis][k] += std::polar(gust[axis], -2 * std::numbers::pi * bins[k] * tick / length);
                }
            }
            double noise[simulation::noise_count];
            simulation::draw_noise(simulation::normal_levels(), own.world.tape, tick, noise, 1);
            simulation::FlightMemory next;
            simulation::pass_tick(own.numbers, {}, memory, noise, next);
            memory = next;
        }
        for (int axis = 0; axis < 2; ++axis) {
            for (int k = 0; k < 6; ++k) {
                power[axis][k] += std::norm(sums[axis][k]) * tick_s / length / pieces;  // two-sided, per Hz
            }
        }
    }
    CHECK(variance[0] == Approx(0.16).epsilon(0.06));
    CHECK(variance[1] == Approx(0.16).epsilon(0.06));
    for (int k = 0; k < 6; ++k) {
        const double omega = 2 * std::numbers::pi * bins[k] / (length * tick_s);
        // MIL-F-8785C 3.7.2.1 as one-sided spectra over the spatial frequency; per Hz of two-sided ones: times pi / V.
        const double along = omega / speed_m_s * 2;
        const double upward = omega / speed_m_s * 1;
        const double x = 0.16 * 2 * 2 / std::numbers::pi / (1 + along * along);
        const double z = 0.16 * 1 / std::numbers::pi * (1 + 3 * upward * upward) / std::pow(1 + upward * upward, 2);
        INFO("at " << omega << " rad/s");
        CHECK(power[0][k] == Approx(x * std::numbers::pi / speed_m_s).epsilon(0.35));
        CHECK(power[1][k] == Approx(z * std::numbers::pi / speed_m_s).epsilon(0.35));
    }
}
