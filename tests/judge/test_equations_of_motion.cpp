#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "../support/washed_robot.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "downwash/judge/plant.hpp"
#include "downwash/judge/reference.hpp"
#include "downwash/judge/slipstream.hpp"
#include "downwash/simulation/world.hpp"

// The judge's plant in Newton's and Euler's equations of two bodies, against the planner's in generalised coordinates.

using namespace downwash;
using namespace downwash::test;

namespace {

judge::Motion random_motion(Random& random) {
    const auto within = [&](double limit) { return random.uniform(-limit, limit); };
    return {{within(5), within(5)}, {within(3), within(3)}, within(1), within(4), within(3), within(4)};
}

Robot robot_with_drag() {
    Robot robot = test_robot();
    robot.multirotor.drag = {1.5, 0.04};
    robot.arm.drag = {0.2, 0.05};
    robot.arm.joint_x_m = 0.05;
    robot.arm.joint_z_m = -0.07;
    return robot;
}

/// K = 1 and wind.
struct Air : FreeAir {
    explicit Air(const dynamics::PlanePoint<double>& moving) : air(moving) {}
    dynamics::PlanePoint<double> air;
    static constexpr bool has_wind = true;
    [[nodiscard]] dynamics::PlanePoint<double> wind() const { return air; }
};

/// The same with slipstreams, slower than those of the model.
struct Washed : Air {
    Washed(const dynamics::PlanePoint<double>& wind, const Slipstreams& of) : Air(wind), all(of) {}
    const Slipstreams& all;
    static constexpr bool has_wash = true;
    [[nodiscard]] const Slipstreams& slipstreams() const { return all; }
    [[nodiscard]] double wash_scale() const { return 0.8; }
};

const World calm{};

}  // namespace

TEST_CASE("Two bodies and a joint accelerate like the generalised coordinates") {
    const Robot robot = robot_with_drag();
    const judge::Vehicle vehicle = judge::vehicle_in({}, robot);
    const judge::Surroundings free_air(nullptr, calm);
    const judge::Plant plant(vehicle, free_air);
    const PlantModel model = make_plant_model(robot.multirotor, robot.arm, robot.rotors);
    Random random(11);
    int compared = 0;
    for (int n = 0; n < 1000; ++n) {
        const judge::Motion m = random_motion(random);
        const double q[] = {m.position_m.x, m.position_m.z, m.pitch_rad, m.arm_rad};
        const double u[] = {m.velocity_m_s.x, m.velocity_m_s.z, m.pitch_rate_rad_s, m.arm_rate_rad_s};
        std::array<double, max_rotors> thrust_n{};
        for (std::size_t i = 0; i < 4; ++i) {
            thrust_n[i] = random.uniform(0, 28);
        }
        const double torque_nm = random.uniform(-12, 12);
        const judge::Planar wind{random.uniform(-2, 2), random.uniform(-1, 1)};
        // The planner's Gauss rule is exact only where the stream crosses the arm from one side.
        const judge::Planar e = judge::arm_direction(m.pitch_rad, m.arm_rad);
        const judge::Planar joint =
            m.velocity_m_s - wind + judge::turned(m.pitch_rate_rad_s, judge::from_body({0.05, -0.07}, m.pitch_rad));
        const double at_joint = joint.x * e.z - joint.z * e.x;
        if (at_joint * (at_joint + (m.pitch_rate_rad_s + m.arm_rate_rad_s) * robot.arm.length_m) < 0) {
            continue;
        }
        double du[4];
        dynamics::accelerations(model, q, u, dynamics::motion_at(model, q, u), thrust_n.data(), torque_nm,
                                Air({wind.x, wind.z}), du);
        const judge::Acceleration a = plant.acceleration(m, thrust_n, torque_nm, wind);
        CHECK(std::abs(a.position_m_s2.x - du[0]) < 1e-9);
        CHECK(std::abs(a.position_m_s2.z - du[1]) < 1e-9);
        CHECK(std::abs(a.pitch_rad_s2 - du[2]) < 1e-9);
        CHECK(std::abs(a.arm_rad_s2 - du[3]) < 1e-9);
        ++compared;
    }
    CHECK(compared > 300);
}

TEST_CASE("The judge's slipstream moves as fast as the planner's") {
    Random random(21);
    for (int n = 0; n < 2000; ++n) {
        const double depth = random.uniform(-0.6, 14);
        const double away = random.uniform(0, 4);
        CHECK(judge::slipstream_ratio(0.2, 0.2 * depth, 0.2 * away) ==
              Approx(dynamics::slipstream_speed(depth, away * away)).epsilon(1e-3).margin(1e-3));
    }
}

TEST_CASE("Two bodies and a joint accelerate in the wash like the generalised coordinates") {
    Robot robot = washed_robot();
    robot.arm.joint_x_m = 0.05;
    robot.arm.joint_z_m = -0.07;
    robot.arm.wash->scale = 1.1;
    World world;
    world.arm_wash_scale = -0.2;
    world.center_of_mass_x_m = 0.01;
    const judge::Vehicle vehicle = judge::vehicle_in(world, robot);
    const judge::Surroundings free_air(nullptr, calm);
    const judge::Plant plant(vehicle, free_air);
    const FlownWorld flown = make_world(robot, world);
    PlantModel model = plant_of(robot);
    static_cast<PlantNumbers<double>&>(model) = flown.numbers.plant;
    const Slipstreams slipstreams = slipstreams_of(robot.arm, robot.rotors);
    Random random(22);
    double worst[4] = {}, largest[4] = {};
    for (int n = 0; n < 400; ++n) {
        judge::Motion m = random_motion(random);
        m.velocity_m_s = 0.3 * m.velocity_m_s;
        m.pitch_rate_rad_s *= 0.1;
        m.arm_rate_rad_s *= 0.2;
        const double q[] = {m.position_m.x, m.position_m.z, m.pitch_rad, m.arm_rad};
        const double u[] = {m.velocity_m_s.x, m.velocity_m_s.z, m.pitch_rate_rad_s, m.arm_rate_rad_s};
        std::array<double, max_rotors> thrust_n{};
        for (std::size_t i = 0; i < 4; ++i) {
            thrust_n[i] = random.uniform(8, 16);
        }
        double du[4], calm_du[4];
        const auto motion = dynamics::motion_at(model, q, u);
        dynamics::accelerations(model, q, u, motion, thrust_n.data(), 0.0, Washed({0.2, 0.1}, slipstreams), du);
        dynamics::accelerations(model, q, u, motion, thrust_n.data(), 0.0, Air({0.2, 0.1}), calm_du);
        const judge::Acceleration a = plant.acceleration(m, thrust_n, 0, {0.2, 0.1});
        const double mine[] = {a.position_m_s2.x, a.position_m_s2.z, a.pitch_rad_s2, a.arm_rad_s2};
        for (int i = 0; i < 4; ++i) {
            worst[i] = std::max(worst[i], std::abs(mine[i] - du[i]));
            largest[i] = std::max(largest[i], std::abs(du[i] - calm_du[i]));
        }
    }
    for (int i = 0; i < 4; ++i) {
        CAPTURE(i);
        CHECK(worst[i] < 0.05 * largest[i]);  // the planner's twelve points
        CHECK(largest[i] > 0.05);
    }
}

TEST_CASE("Energy goes where work and drag put it") {
    const bool has_drag = GENERATE(false, true);
    Robot robot = has_drag ? robot_with_drag() : test_robot();
    const judge::Vehicle vehicle = judge::vehicle_in({}, robot);
    const judge::Surroundings free_air(nullptr, calm);
    const judge::Plant plant(vehicle, free_air);
    Random random(12);
    for (int n = 0; n < 20; ++n) {
        judge::PlantState state;
        state.motion = random_motion(random);
        const double before_j = judge::mechanical_energy_j(vehicle, state.motion);
        const judge::PlantState after = plant.after(state, {}, {}, 0.5);  // falls, tumbles, arm swinging freely
        const double change_j = judge::mechanical_energy_j(vehicle, after.motion) - before_j;
        if (has_drag) {
            CHECK(change_j < 0);
        } else {
            CHECK(std::abs(change_j) < 1e-5);
        }
        CHECK(after.energy_j == 0);
    }
}

TEST_CASE("A joint torque does the work of torque times turn, whatever moves") {
    const Robot robot = test_robot();
    const judge::Vehicle vehicle = judge::vehicle_in({}, robot);
    const judge::Surroundings free_air(nullptr, calm);
    const judge::Plant plant(vehicle, free_air);
    Random random(13);
    for (int n = 0; n < 20; ++n) {
        judge::PlantState state;
        state.motion = random_motion(random);
        judge::Command command;
        command.joint_torque_nm = random.uniform(-5, 5);
        const judge::PlantState after = plant.after(state, command, {}, 0.2);
        const double work_j = command.joint_torque_nm * (after.motion.arm_rad - state.motion.arm_rad);
        const double gained_j =
            judge::mechanical_energy_j(vehicle, after.motion) - judge::mechanical_energy_j(vehicle, state.motion);
        CHECK(gained_j == Approx(work_j).margin(1e-5));
    }
}

TEST_CASE("Rotors follow a command with their time constant") {
    Robot robot = test_robot();
    robot.rotors.time_constant_s = 0.05;
    const judge::Vehicle vehicle = judge::vehicle_in({}, robot);
    const judge::Surroundings free_air(nullptr, calm);
    const judge::Plant plant(vehicle, free_air);
    judge::Command command;
    command.thrust_n = {10, 12, 14, 16};
    const judge::PlantState after = plant.after({}, command, {}, 0.05);
    CHECK(after.thrust_n[0] == Approx(10 * (1 - std::exp(-1.0))).epsilon(1e-7));
    CHECK(after.thrust_n[3] == Approx(16 * (1 - std::exp(-1.0))).epsilon(1e-7));
}

TEST_CASE("Between two points at rest the reference is 10 s^3 - 15 s^4 + 6 s^5 of the way") {
    Plan plan;
    plan.tick_s = 0.01;
    plan.reference = {{0, at_rest({1, 2, 0.5})}, {200, at_rest({3, 1, 1.5})}};
    judge::Reference reference(plan);
    for (const std::int64_t tick : {0, 1, 50, 100, 177, 200, 260}) {
        const double s = std::min(1.0, static_cast<double>(tick) / 200);
        const double way = s * s * s * (10 - 15 * s + 6 * s * s);
        const ReferencePoint point = reference.at(tick);
        CHECK(point.position[0] == Approx(1 + 2 * way).margin(1e-12));
        CHECK(point.position[1] == Approx(2 - way).margin(1e-12));
        CHECK(point.velocity[2] == Approx(30 * s * s * (1 - s) * (1 - s) / 2).margin(1e-12));
        CHECK(point.acceleration[0] == Approx(2 * 60 * s * (1 - s) * (1 - 2 * s) / 4).margin(1e-12));
    }
}

TEST_CASE("A piece with moving ends is the planner's quintic") {
    Random random(14);
    Plan plan;
    plan.tick_s = 0.01;
    ReferencePoint ends[2];
    for (ReferencePoint& end : ends) {
        for (int axis = 0; axis < 3; ++axis) {
            end.position[axis] = random.uniform(-3, 3);
            end.velocity[axis] = random.uniform(-1, 1);
            end.acceleration[axis] = random.uniform(-1, 1);
        }
    }
    plan.reference = {{0, ends[0]}, {170, ends[1]}};
    const ReferenceSegment segment(ends[0], ends[1], 170, 0.01);
    judge::Reference reference(plan);
    for (std::int64_t tick = 0; tick <= 170; ++tick) {
        const ReferencePoint mine = reference.at(tick);
        const ReferencePoint theirs = segment.at_tick(tick);
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(mine.position[axis] == Approx(theirs.position[axis]).margin(1e-12));
            CHECK(mine.velocity[axis] == Approx(theirs.velocity[axis]).margin(1e-11));
            CHECK(mine.acceleration[axis] == Approx(theirs.acceleration[axis]).margin(1e-10));
        }
    }
}
