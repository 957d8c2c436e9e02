#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>
#include <type_traits>
#include <vector>

#include "../support/random.hpp"
#include "../support/space_robots.hpp"
#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_loop_of.hpp"

// Flights in space where plant, surfaces, sensors and air are not what the controller believes.

using namespace downwash;
using namespace downwash::test;

namespace {

/// Everything different, a little, but for noise.
SpaceWorld random_world(Random& random) {
    const auto vector = [&](double most) {
        return Vector3{random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most)};
    };
    SpaceWorld world;
    world.ceiling_scale = random.uniform(-0.3, 0.3);
    world.ground_scale = random.uniform(-0.3, 0.3);
    world.scene_m = vector(0.04);
    world.scene_yaw_rad = random.uniform(-0.01, 0.01);
    world.mass_scale = random.uniform(-0.05, 0.05);
    world.inertia_scale = random.uniform(-0.1, 0.1);
    world.center_of_mass_m = vector(0.01);
    world.thrust_scale = random.uniform(-0.05, 0.05);
    world.rotor_time_constant_s = random.uniform(-0.005, 0.01);
    world.delay_s = random.uniform(0, 0.01);
    world.position_bias_m = vector(0.02);
    world.attitude_bias_rad = vector(0.01);
    world.wind_m_s = vector(1);
    for (double& scale : world.rotor_thrust_scale) {
        scale = random.uniform(-0.02, 0.02);
    }
    for (int i = 0; i < max_joints; ++i) {
        world.link_mass_scale[i] = random.uniform(-0.1, 0.1);
        world.joint_offset_rad[i] = random.uniform(-0.01, 0.01);
    }
    return world;
}

/// K that is smooth and differs from place to place, by side.
class Slope final : public simulation::SpaceEffect {
 public:
    SidedFactor<double> at_rotor(int /*rotor*/, const dynamics::LaneVector<double>& hub_m) override {
        const double above = 1 + 0.1 / (1 + (3 - hub_m.z) * (3 - hub_m.z) + hub_m.x * hub_m.x);
        const double below = 0.05 / (1 + hub_m.z * hub_m.z + hub_m.y * hub_m.y);
        return {above + below, above};
    }
};

/// A hover at a place in free air.
struct Hover {
    SpaceRobot robot;
    SpaceWorld world;
    SpacePlan plan;
    SpaceMotion start;

    Hover(const SpaceRobot& flown, const SpaceWorld& in, double yaw_rad = 0) : robot(flown), world(in) {
        plan.tick_s = 1 / robot.controller.rate_hz;
        plan.joints = robot.joints();
        SpacePoint here;
        here.position[space::z] = 2;
        here.position[space::yaw] = yaw_rad;
        plan.reference = {{0, here}, {1, here}};
        start = motion_at_rest(here);
    }
    [[nodiscard]] SpaceFlight fly_for(double time_s) const {
        SpaceFlightSettings settings;
        settings.world = world;
        settings.hold_ticks = std::llround(time_s / plan.tick_s);
        settings.is_refined = false;
        return fly(robot, plan, start, settings);
    }
};

template <int n>
void check_nominal_is_plain(const SpaceLaw& law) {
    SpaceRobot robot = space_robot(n);
    robot.controller.law = law;
    robot.plant.wash = WashParameters{1.2};
    const SpacePlan plan = space_plan(n);
    Slope slope;
    simulation::SpaceAero aero;
    aero.tilt_loss = {0.37, 0.1};
    const auto model = simulation::make_space_tick_model<n>(robot, aero);
    const FlownSpaceWorld<n> nominal = make_space_world<n>(robot, {});
    const auto plant = simulation::plant_in(model, nominal.numbers);
    simulation::SpaceFlightState<double, n> in_world{};
    static_cast<simulation::SpaceVehicle<double, n>&>(in_world) =
        simulation::vehicle_at(model, motion_at_rest(plan.reference.front().point));
    in_world.world = memory_at_start(nominal, in_world.plant);
    simulation::SpaceVehicle<double, n> plain = in_world;
    const double no_noise[simulation::space_noise_count] = {};
    std::visit(
        [&](const auto& own) {
            for (std::int64_t tick = 0; tick < 1200; ++tick) {
                const auto reference = simulation::point_for<n>(plan.at(tick));
                simulation::SpaceActuation<double, n> given{}, given_in_world{};
                simulation::SpaceVehicle<double, n> next{};
                simulation::tick(model, own, plain, reference, slope, given, next);
                plain = next;
                auto next_in_world = in_world;
                simulation::tick_in_world(model, own, nominal.numbers, plant, no_noise, in_world, reference, slope,
                                          given_in_world, next_in_world);
                in_world = next_in_world;
                REQUIRE(std::memcmp(&given, &given_in_world, sizeof given) == 0);
                REQUIRE(std::memcmp(&plain.plant, &in_world.plant, sizeof plain.plant) == 0);
                REQUIRE(std::memcmp(&plain.memory, &in_world.memory, sizeof plain.memory) == 0);
            }
        },
        robot.controller.law);
    CHECK(std::hypot(plain.plant.q[0], plain.plant.q[1], plain.plant.q[2] - 2) < 0.2);
}

}  // namespace

TEST_CASE("In space the world without any difference is the plain tick, to the last bit") {
    const double lag_s = space_robot(0).plant.time_constant_s;
    const SpaceLaw law = GENERATE_COPY(SpaceLaw(gains_for(lag_s, {})), SpaceLaw(cascade_gains_for(lag_s, {})));
    check_nominal_is_plain<0>(law);
    check_nominal_is_plain<1>(law);
    check_nominal_is_plain<2>(law);
    check_nominal_is_plain<3>(law);
}

TEST_CASE("A flight in a world in space is the same again, and another one in another world") {
    Random random(4);
    const SpaceRobot robot = space_robot(2);
    const SpacePlan plan = space_plan(2);
    SpaceFlightSettings settings;
    settings.world = random_world(random);
    settings.world.position_noise_m = 0.005;
    settings.world.velocity_noise_m_s = 0.02;
    settings.world.gyro_noise_rad_s = 0.015;
    settings.world.gust_m_s = 0.3;
    settings.world.gust_length_level_m = 20;
    settings.world.gust_length_up_m = 3;
    settings.world.tape = 11;
    const SpaceMotion start = motion_at_rest(plan.reference.front().point);
    const SpaceFlight one = fly(robot, plan, start, settings);
    const SpaceFlight two = fly(robot, plan, start, settings);
    settings.world.tape = 12;
    const SpaceFlight other = fly(robot, plan, start, settings);
    REQUIRE(one.outcome == Outcome::ok);
    CHECK(one.rows.back().motion == two.rows.back().motion);
    CHECK(one.energy_j == two.energy_j);
    CHECK(one.rows.back().motion != other.rows.back().motion);
}

TEST_CASE("A controller in space sees what was a delay ago, linear between two ticks, however long") {
    SpaceWorld late;
    late.delay_s = GENERATE(0.015, 0.125);
    constexpr int n = 2;
    const SpaceRobot robot = space_robot(n);
    const FlownSpaceWorld<n> world = make_space_world<n>(robot, late);
    dynamics::SpaceState<double, n> state{};
    state.q[3] = 1;
    auto memory = memory_at_start(world, state);
    const double no_noise[simulation::space_noise_count] = {};
    const double ticks = late.delay_s * robot.controller.rate_hz;
    for (int tick = 1; tick <= 30; ++tick) {
        auto next = memory;
        simulation::pass_tick(world.numbers, state, memory, no_noise, next);
        memory = next;
        state.q[1] = tick;
        state.q[8] = -2.0 * tick;
        state.u[5] = 10.0 * tick;
        const auto seen = simulation::seen_state(world.numbers, state, memory, no_noise);
        const double expected = std::max(0.0, tick - ticks);
        // Between the first two ticks the vehicle begins to move.
        if (tick - ticks > 0 || tick - ticks <= -1) {
            CHECK(seen.q[1] == Approx(expected).margin(1e-12));
            CHECK(seen.q[8] == Approx(-2 * expected).margin(1e-12));
            CHECK(seen.u[5] == Approx(10 * expected).margin(1e-12));
        }
        CHECK(seen.q[3] == Approx(1).margin(1e-15));
    }
    CHECK(memory.older.size() == (late.delay_s > 0.1 ? 10 : 0));
}

TEST_CASE("Biases move the vehicle by as much the other way, in three axes") {
    SpaceWorld world;
    world.position_bias_m = {0.03, -0.02, 0.01};
    const SpaceFlight biased = Hover(space_robot(1), world).fly_for(40);
    const Vector3& at_m = biased.rows.back().motion.position_m;
    CHECK(at_m[0] == Approx(-0.03).margin(1e-4));
    CHECK(at_m[1] == Approx(0.02).margin(1e-4));
    CHECK(at_m[2] == Approx(1.99).margin(1e-4));

    SpaceWorld turned;
    turned.attitude_bias_rad = {0, 0, 0.05};
    const SpaceFlight heading = Hover(space_robot(0), turned, 0.4).fly_for(40);
    const auto& q = heading.rows.back().motion.attitude;
    CHECK(2 * std::atan2(q[3], q[0]) == Approx(0.35).margin(1e-3));

    SpaceWorld bent;
    bent.joint_offset_rad[1] = 0.04;
    const SpaceFlight arm = Hover(space_robot(2), bent).fly_for(40);
    CHECK(arm.rows.back().motion.joints_rad[0] == Approx(0).margin(1e-3));
    CHECK(arm.rows.back().motion.joints_rad[1] == Approx(-0.04).margin(1e-3));
}

TEST_CASE("A bias of the attitude is a turn about an axis of the body") {
    const Vector3 bias_rad{0.2, -0.3, 0.1};
    SpaceWorld world;
    world.attitude_bias_rad = bias_rad;
    const FlownSpaceWorld<0> flown = make_space_world<0>(space_robot(0), world);
    dynamics::SpaceState<double, 0> seen{{0, 0, 0, 0.5, -0.5, 0.7, 0.1}, {}, {}, 0};
    dynamics::normalise_attitude(seen.q);
    const auto before = dynamics::rotation_of(seen.q + 3);
    const double no_noise[simulation::space_noise_count] = {};
    simulation::add_errors(flown.numbers, no_noise, seen);
    const double angle_rad = std::sqrt(dot(bias_rad, bias_rad));
    const dynamics::LaneVector<double> axis{bias_rad[0] / angle_rad, bias_rad[1] / angle_rad, bias_rad[2] / angle_rad};
    const auto expected = before * dynamics::rotation_about(axis, angle_rad);
    const auto found = dynamics::rotation_of(seen.q + 3);
    CHECK(found.first.x == Approx(expected.first.x).margin(1e-14));
    CHECK(found.second.z == Approx(expected.second.z).margin(1e-14));
    CHECK(found.third.y == Approx(expected.third.y).margin(1e-14));
}

TEST_CASE("Heavier vehicles, heavier links and weaker rotors hover with more command") {
    const SpaceRobot robot = space_robot(2);
    SpaceWorld world;
    world.mass_scale = 0.04;
    world.link_mass_scale[0] = 0.2;
    world.link_mass_scale[1] = -0.1;
    world.thrust_scale = -0.05;
    const SpaceFlight flight = Hover(robot, world).fly_for(40);
    const double mass_kg = 2.3 * 1.04 + 0.15 * 1.2 + 0.15 * 0.9;
    double lift_n = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        const Vector3& axis = robot.plant.rotors[i].axis;
        lift_n += flight.rows.back().rotor_lag_n[i] / std::sqrt(dot(axis, axis));
    }
    const auto& q = flight.rows.back().motion.attitude;
    const double upright = 1 - 2 * (q[1] * q[1] + q[2] * q[2]);
    CHECK(0.95 * lift_n * upright == Approx(mass_kg * standard_gravity_m_s2).epsilon(1e-4));
    CHECK(flight.rows.back().motion.position_m[2] == Approx(2).margin(1e-3));

    // One weak rotor commands more than it did, and stays where it was.
    SpaceWorld weak;
    weak.rotor_thrust_scale[2] = -0.05;
    const SpaceFlight one = Hover(robot, weak).fly_for(40);
    const SpaceFlight none = Hover(robot, {}).fly_for(40);
    CHECK(0.95 * one.rows.back().rotor_lag_n[2] == Approx(none.rows.back().rotor_lag_n[2]).epsilon(0.02));
    CHECK(one.rows.back().motion.position_m[0] == Approx(0).margin(1e-3));
}

TEST_CASE("A vehicle with another centre of mass hovers where that is above the thrust") {
    // Torque balance about the true centre of mass: the moment of all thrusts vanishes there.
    const SpaceRobot robot = space_robot(0);
    SpaceWorld world;
    world.center_of_mass_m = {0.02, -0.015, 0.01};
    const SpaceFlight flight = Hover(robot, world).fly_for(40);
    const SpaceFlightRow& row = flight.rows.back();
    Vector3 moment_nm{};
    for (std::size_t i = 0; i < 6; ++i) {
        const SpaceRotor& rotor = robot.plant.rotors[i];
        const Vector3 axis = (1 / std::sqrt(dot(rotor.axis, rotor.axis))) * rotor.axis;
        moment_nm = moment_nm + row.rotor_lag_n[i] * (cross(rotor.position_m - world.center_of_mass_m, axis) -
                                                      rotor.spin * rotor.drag_torque_m * axis);
    }
    for (const double component : moment_nm) {
        CHECK(component == Approx(0).margin(1e-4));
    }
    CHECK(row.motion.position_m[0] == Approx(0).margin(1e-3));
    CHECK(row.motion.position_m[1] == Approx(0).margin(1e-3));
    // Free fall: the true centre of mass, not that of the robot file, falls straight while the vehicle turns.
    const FlownSpaceWorld<0> flown = make_space_world<0>(robot, world);
    const auto model = simulation::make_space_tick_model<0>(robot);
    SpaceRobot without_air = robot;
    without_air.plant.drag = {};
    auto plant = simulation::plant_in(model, flown.numbers);
    plant.has_drag = false;
    dynamics::SpaceState<double, 0> state{{0, 0, 0, 1, 0, 0, 0}, {0.3, 0.2, 0.1, 2, 1, -3}, {}, 0};
    const dynamics::SpaceCommand<double, 0> off{};
    const auto center = [&](const dynamics::SpaceState<double, 0>& at) {
        return dynamics::LaneVector<double>{at.q[0], at.q[1], at.q[2]} +
               dynamics::rotation_of(at.q + 3) * flown.numbers.center_of_mass_m;
    };
    auto moving = state;
    simulation::shift_center_of_mass(flown.numbers.center_of_mass_m, 1.0, moving);
    const auto begin = center(state);
    const double velocity[3] = {moving.u[0], moving.u[1], moving.u[2]};
    for (int i = 0; i < 100; ++i) {
        moving = dynamics::space_step(plant, moving, off, 0.01, dynamics::CalmSpace{});
    }
    state = moving;
    simulation::shift_center_of_mass(flown.numbers.center_of_mass_m, -1.0, state);
    const auto end = center(state);
    CHECK(end.x == Approx(begin.x + velocity[0]).margin(1e-9));
    CHECK(end.y == Approx(begin.y + velocity[1]).margin(1e-9));
    CHECK(end.z == Approx(begin.z + velocity[2] - 0.5 * standard_gravity_m_s2).margin(1e-9));
}

TEST_CASE("A steady wind is leant against, from any side") {
    const double angle = GENERATE(0.0, 2.0, 4.5);
    SpaceRobot robot = space_robot(0);
    SpaceWorld windy;
    windy.wind_m_s = {2 * std::cos(angle), 2 * std::sin(angle), 0.3};
    const SpaceFlight flight = Hover(robot, windy, 0.7).fly_for(60);
    const double speed = std::sqrt(4 + 0.09);
    const double per_speed = 0.3 + 0.02 * speed;
    const auto& q = flight.rows.back().motion.attitude;
    // The thrust axis in the world: its level part is against the wind.
    const double b3[3] = {2 * (q[1] * q[3] + q[0] * q[2]), 2 * (q[2] * q[3] - q[0] * q[1]),
                          1 - 2 * (q[1] * q[1] + q[2] * q[2])};
    const double upward_n = 2.3 * standard_gravity_m_s2 - per_speed * 0.3;
    CHECK(b3[0] / b3[2] == Approx(-per_speed * windy.wind_m_s[0] / upward_n).margin(1e-3));
    CHECK(b3[1] / b3[2] == Approx(-per_speed * windy.wind_m_s[1] / upward_n).margin(1e-3));
    CHECK(std::hypot(flight.rows.back().motion.position_m[0], flight.rows.back().motion.position_m[1]) < 0.01);
}

TEST_CASE("Surfaces of a world in space act where they really are, each side by its own scale") {
    Slope slope;
    SpaceWorld world;
    world.ceiling_scale = 0.2;
    world.ground_scale = -0.1;
    world.scene_m = {0.3, -0.2, 0.1};
    world.scene_yaw_rad = 0.5;
    const FlownSpaceWorld<0> flown = make_space_world<0>(space_robot(0), world);
    const TiltLoss tilt_loss{0.37, 0.2};
    const simulation::WorldSpace<double, simulation::SpaceEffect> around(flown.numbers, {0, 0, 0}, slope, tilt_loss,
                                                                         no_space_slipstreams);
    Random random(8);
    for (int trial = 0; trial < 50; ++trial) {
        // A place among surfaces in their nominal places, and where the world has it.
        const double x = random.uniform(-2, 2), y = random.uniform(-2, 2), z = random.uniform(0, 3);
        const dynamics::LaneVector<double> there{std::cos(0.5) * x - std::sin(0.5) * y + 0.3,
                                                 std::sin(0.5) * x + std::cos(0.5) * y - 0.2, z + 0.1};
        const double tilt = random.uniform(0, 0.6), to = random.uniform(0, 6);
        const dynamics::LaneVector<double> axis{std::sin(tilt) * std::cos(to), std::sin(tilt) * std::sin(to),
                                                std::cos(tilt)};
        const auto level = slope.at_rotor(0, {x, y, z});
        const auto faded = [&](double change, double loss) {
            return change * change / (change + loss * std::sin(tilt) * std::sin(tilt));
        };
        const double expected = 1 + 0.9 * faded(level.all - level.above, 0.37) + 1.2 * faded(level.above - 1, 0.2);
        CHECK(around.thrust_ratio(0, there, axis) == Approx(expected).epsilon(1e-12));
        const Vector3 seen = among_obstacles(Vector3{there.x, there.y, there.z}, world);
        CHECK(seen[0] == Approx(x).margin(1e-12));
        CHECK(seen[1] == Approx(y).margin(1e-12));
        CHECK(seen[2] == Approx(z).margin(1e-12));
    }
    // Obstacles see the attitude turned back, too.
    SpaceMotion motion;
    motion.attitude = {std::cos(0.25), 0, 0, std::sin(0.25)};
    const SpacePose pose = among_obstacles(motion, world);
    CHECK(pose.attitude[0] == Approx(1));
    CHECK(pose.attitude[3] == Approx(0).margin(1e-15));
}

TEST_CASE("The lag and the noise of a world are those that it says") {
    const SpaceRobot robot = space_robot(1);
    SpaceWorld world;
    world.rotor_time_constant_s = 0.02;
    CHECK(make_space_world<1>(robot, world).numbers.plant.rotor_time_constant_s == Approx(0.05));
    world = {};
    world.inertia_scale = 0.1;
    world.link_mass_scale[0] = 0.2;
    const auto numbers = make_space_world<1>(robot, world).numbers;
    CHECK(numbers.plant.inertia_kg_m2.xy == Approx(0.0011));
    CHECK(numbers.plant.link[0].inertia_kg_m2.yy == Approx(4e-4 * 1.1 * 1.2));
    CHECK(numbers.plant.link[0].mass_kg == Approx(0.18));

    world = {};
    world.position_noise_m = 0.01;
    world.velocity_noise_m_s = 0.02;
    world.gyro_noise_rad_s = 0.03;
    world.tape = 5;
    const FlownSpaceWorld<1> noisy = make_space_world<1>(robot, world);
    REQUIRE(noisy.has_noise);
    double squares[9] = {};
    double products = 0;
    constexpr int ticks = 20000;
    for (int tick = 0; tick < ticks; ++tick) {
        double noise[simulation::drawn_space_noise_count];
        simulation::draw_space_noise(simulation::normal_levels(), noisy.tape, tick, noise, 1);
        dynamics::SpaceState<double, 1> seen{{0, 0, 0, 1, 0, 0, 0, 0.3}, {}, {}, 0};
        simulation::add_errors(noisy.numbers, noise, seen);
        CHECK(seen.q[7] == 0.3);
        for (int i = 0; i < 3; ++i) {
            squares[i] += seen.q[i] * seen.q[i] / ticks;
            squares[3 + i] += seen.u[i] * seen.u[i] / ticks;
            squares[6 + i] += seen.u[3 + i] * seen.u[3 + i] / ticks;
        }
        for (int i = 0; i + 1 < simulation::drawn_space_noise_count; ++i) {
            products += noise[i] * noise[i + 1] / 14 / ticks;
        }
    }
    for (int i = 0; i < 9; ++i) {
        CHECK(std::sqrt(squares[i]) == Approx(0.01 * (1 + i / 3)).epsilon(0.03));
    }
    CHECK(std::abs(products) < 0.01);
}

TEST_CASE("Gusts in space have the variance and the spectrum of the Dryden model in three axes") {
    SpaceWorld world;
    world.gust_m_s = 0.4;
    world.gust_length_level_m = 2;
    world.gust_length_up_m = 1;
    constexpr double heading = 0.6;
    world.wind_m_s = {2.5 * std::cos(heading), 2.5 * std::sin(heading), 0};
    constexpr double tick_s = 0.01, speed_m_s = 2.5;
    constexpr int length = 4096;
    constexpr int pieces = 150;
    const int bins[] = {3, 6, 12, 24, 48, 96};
    double power[3][6] = {};
    double covariance[3][3] = {};
    const SpaceRobot robot = space_robot(0);
    for (int piece = 0; piece < pieces; ++piece) {
        world.tape = static_cast<std::uint64_t>(piece);
        const FlownSpaceWorld<0> own = make_space_world<0>(robot, world);
        auto memory = memory_at_start(own, dynamics::SpaceState<double, 0>{});
        std::complex<double> sums[3][6];
        for (int tick = 0; tick < length; ++tick) {
            const auto wind = simulation::wind_in(own.numbers, memory.gust);
            const double x = wind.x - world.wind_m_s[0], y = wind.y - world.wind_m_s[1];
            const double gust[3] = {std::cos(heading) * x + std::sin(heading) * y,
                                    std::cos(heading) * y - std::sin(heading) * x, wind.z};
            for (int axis = 0; axis < 3; ++axis) {
                for (int other = 0; other < 3; ++other) {
                    covariance[axis][other] += gust[axis] * gust[other] / length / pieces;
                }
                for (int k = 0; k < 6; ++k) {
                    sums[axis][k] += std::polar(gust[axis], -2 * std::numbers::pi * bins[k] * tick / length);
                }
            }
            double noise[simulation::drawn_space_noise_count];
            simulation::draw_space_noise(simulation::normal_levels(), own.tape, tick, noise, 1);
            auto next = memory;
            simulation::pass_tick(own.numbers, {}, memory, noise, next);
            memory = next;
        }
        for (int axis = 0; axis < 3; ++axis) {
            for (int k = 0; k < 6; ++k) {
                power[axis][k] += std::norm(sums[axis][k]) * tick_s / length / pieces;  // two-sided, per Hz
            }
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (int other = 0; other < 3; ++other) {
            CAPTURE(axis, other);
            CHECK(covariance[axis][other] == Approx(axis == other ? 0.16 : 0).margin(0.012));
        }
    }
    for (int k = 0; k < 6; ++k) {
        const double omega = 2 * std::numbers::pi * bins[k] / (length * tick_s);
        INFO("at " << omega << " rad/s");
        // MIL-F-8785C 3.7.2.1 as one-sided spectra over the spatial frequency; per Hz of two-sided ones: times pi / V.
        const double level = omega / speed_m_s * 2;
        const double upward = omega / speed_m_s * 1;
        const double per_hz = 1 / speed_m_s;
        const auto across = [](double l, double w) { return 0.16 * l * (1 + 3 * w * w) / std::pow(1 + w * w, 2); };
        CHECK(power[0][k] == Approx(per_hz * 0.16 * 2 * 2 / (1 + level * level)).epsilon(0.35));
        CHECK(power[1][k] == Approx(per_hz * across(2, level)).epsilon(0.35));
        CHECK(power[2][k] == Approx(per_hz * across(1, upward)).epsilon(0.35));
    }
}

TEST_CASE("Gusts begin with numbers that no tick draws") {
    constexpr int tapes = 4000;
    double products[5][simulation::space_noise_count] = {};
    for (std::uint64_t tape = 0; tape < tapes; ++tape) {
        double gust[5];
        simulation::start_gusts(tape, gust);
        double noise[simulation::drawn_space_noise_count];
        simulation::draw_space_noise(simulation::normal_levels(), tape, 0, noise, 1);
        for (int i = 0; i < 5; ++i) {
            for (int k = 0; k < simulation::space_noise_count; ++k) {
                products[i][k] += gust[i] * noise[k] / tapes;
            }
        }
    }
    for (int i = 0; i < 5; ++i) {
        for (int k = 0; k < simulation::space_noise_count; ++k) {
            CAPTURE(i, k);
            CHECK(std::abs(products[i][k]) < 0.08);  // 5 standard deviations
        }
    }
}
