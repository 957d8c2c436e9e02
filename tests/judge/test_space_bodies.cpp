#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "../support/test_robot.hpp"
#include "downwash/dynamics/space_slipstreams.hpp"
#include "downwash/judge/plant.hpp"
#include "space_flights.hpp"

// The judge's plant in maximal coordinates: its constraints, conservation laws, and the planner's plant in generalised
// coordinates.

using namespace downwash;
using namespace downwash::test;
using Eigen::Vector3d;

namespace {

const SpaceWorld calm{};
const judge::SpaceSurroundings free_air(nullptr, calm);

/// A plant of no rotors' thrust, which tumbles.
template <int n>
struct Tumbling {
    explicit Tumbling(int seed) : random(seed), robot(robot_of(random_space_plant(random, n))) {
        robot.plant.rotor_inertia_kg_m2 = 0;
        state = random_space_state<n>(random, 2);
        vehicle = judge::vehicle_in(calm, robot);
        bodies = judge::bodies_at(vehicle, test::coordinates_of<n>(state));
    }
    Random random;
    SpaceRobot robot;
    dynamics::SpaceState<double, n> state;
    judge::SpaceVehicle vehicle;
    judge::BodyMotions bodies;

    [[nodiscard]] judge::SpaceCommands nothing() const {
        return {std::vector<double>(vehicle.rotors.size()), Eigen::VectorXd::Zero(n)};
    }
};

struct Momenta {
    Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero(), center_m = Vector3d::Zero();
    double energy_j = 0, mass_kg = 0;
};

/// Sums over bodies; the angular momentum about the common centre of mass.
Momenta momenta_of(const judge::SpaceVehicle& vehicle, const judge::BodyMotions& bodies) {
    Momenta sums;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        sums.mass_kg += vehicle.bodies[i].mass_kg;
        sums.linear += vehicle.bodies[i].mass_kg * bodies[i].velocity_m_s;
        sums.center_m += vehicle.bodies[i].mass_kg * bodies[i].position_m;
    }
    sums.center_m /= sums.mass_kg;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const judge::BodyMotion& b = bodies[i];
        const Vector3d rate = b.attitude.conjugate() * b.rate_rad_s;
        const Vector3d spin = vehicle.bodies[i].inertia_kg_m2 * rate;
        const double mass_kg = vehicle.bodies[i].mass_kg;
        sums.angular += (b.position_m - sums.center_m).cross(mass_kg * b.velocity_m_s) + b.attitude * spin;
        sums.energy_j += 0.5 * (mass_kg * b.velocity_m_s.squaredNorm() + rate.dot(spin)) +
                         mass_kg * standard_gravity_m_s2 * b.position_m.z();
    }
    return sums;
}

template <int n>
void check_free_motion() {
    INFO("joints " << n);
    Tumbling<n> t(40 + n);
    const judge::SpacePlant plant(t.vehicle, free_air);
    judge::SpacePlantState state{t.bodies, t.nothing().thrust_n};
    const Momenta start = momenta_of(t.vehicle, state.bodies);
    double worst_place = 0;
    double worst_speed = 0;
    for (int tick = 0; tick < 2000; ++tick) {
        state = plant.after(state, t.nothing(), Vector3d::Zero(), 0.01);
        const auto errors = plant.linkage().errors(state.bodies);
        worst_place = std::max(worst_place, errors.place);
        worst_speed = std::max(worst_speed, errors.speed);
    }
    CHECK(worst_place < 1e-11);
    CHECK(worst_speed < 1e-11);
    const Momenta end = momenta_of(t.vehicle, state.bodies);
    const Vector3d fallen = start.linear - Vector3d(0, 0, 20 * standard_gravity_m_s2 * start.mass_kg);
    CHECK((end.linear - fallen).norm() < 1e-6 * fallen.norm());
    CHECK((end.angular - start.angular).norm() < 1e-5 * start.angular.norm());
    // Of the energy that falling turns over.
    const double turned_over_j = 0.5 * start.mass_kg * std::pow(20 * standard_gravity_m_s2, 2);
    CHECK(std::abs(end.energy_j - start.energy_j) < 1e-8 * turned_over_j);
}

/// A plant with all that acts on it but a wash. Links have linear drag alone: with another one the planner's Gauss rule
/// is exact only where the stream crosses a link in one direction.
SpaceRobot busy_robot(Random& random, int joints) {
    ::downwash::SpacePlant plant = random_space_plant(random, joints);
    plant.drag = {0.4, 0.1};
    for (SpaceLink& link : plant.links) {
        link.drag = {random.uniform(0, 0.2), 0};
        link.viscous_friction_nm_s = random.uniform(0, 0.05);
        link.coulomb_friction_nm = random.uniform(0, 0.1);
        link.stop = JointStop{random.uniform(-1, -0.2), random.uniform(0.2, 1), random.uniform(1, 50), 1.5};
    }
    plant.end_effector_m = random_vector(random, 0.3);
    return robot_of(plant);
}

template <int n>
void check_accelerations() {
    INFO("joints " << n);
    Random random(70 + n);
    double worst = 0;
    for (int k = 0; k < 300; ++k) {
        const SpaceRobot robot = busy_robot(random, n);
        const auto state = random_space_state<n>(random, 2);
        const judge::SpaceVehicle vehicle = judge::vehicle_in(calm, robot);
        const judge::SpacePlant plant(vehicle, free_air);
        std::vector<double> thrust_n;
        double all_n[max_rotors] = {};
        for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
            thrust_n.push_back(all_n[i] = random.uniform(0, 12));
        }
        Eigen::VectorXd torque_nm(n);
        double joint_nm[room_for<n>] = {};
        for (int i = 0; i < n; ++i) {
            torque_nm[i] = joint_nm[i] = random.uniform(-3, 3);
        }
        const Vector3d wind(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-1, 1));
        const auto model = make_space_model<n>(robot.plant);
        double du[6 + n];
        dynamics::accelerations(model, state.q, state.u, all_n, dynamics::rotor_spin_of(model, all_n), joint_nm,
                                WindInSpace(wind), du);
        const judge::SpaceCoordinates at = test::coordinates_of<n>(state);
        const judge::BodyMotions bodies = judge::bodies_at(vehicle, at);
        const Eigen::VectorXd a = plant.accelerations(bodies, thrust_n, torque_nm, wind);
        double size = 0;
        double off = 0;
        const auto compare = [&](double mine, double theirs) {
            size = std::max(size, std::abs(theirs));
            off = std::max(off, std::abs(mine - theirs));
        };
        // The rate in body axes changes as the one in world axes does, because w x w = 0.
        const Vector3d turn = at.attitude.conjugate() * Vector3d(a.segment<3>(3));
        for (int i = 0; i < 3; ++i) {
            compare(a[i], du[i]);
            compare(turn[i], du[3 + i]);
        }
        for (int i = 0; i < n; ++i) {
            const auto b = static_cast<std::size_t>(i);
            const Vector3d axis = bodies[b].attitude * vehicle.joints[b].axis;
            const Vector3d relative = a.segment<3>(6 * i + 9) - a.segment<3>(6 * i + 3);
            compare(axis.dot(relative), du[6 + i]);  // the rest of its derivative is across the axis
        }
        worst = std::max(worst, off / size);
    }
    CHECK(worst < 1e-9);
}

template <int n>
void check_flight(bool has_lag) {
    INFO("joints " << n << ", lag " << has_lag);
    Random random(90 + n);
    SpaceRobot robot = busy_robot(random, n);
    robot.plant.time_constant_s = has_lag ? 0.04 : 0;
    for (SpaceLink& link : robot.plant.links) {
        link.stop.reset();  // between bounces no step of fixed length is exact enough to compare with
    }
    const judge::SpaceVehicle vehicle = judge::vehicle_in(calm, robot);
    const judge::SpacePlant plant(vehicle, free_air);
    const auto model = make_space_model<n>(robot.plant);
    auto state = random_space_state<n>(random, 1);
    judge::SpacePlantState judged{judge::bodies_at(vehicle, test::coordinates_of<n>(state)),
                                  std::vector<double>(vehicle.rotors.size(), 2.0)};
    std::fill_n(state.thrust_n, vehicle.rotors.size(), 2.0);
    const Vector3d wind(0.8, -0.5, 0.2);
    Eigen::VectorXd near_rad = test::coordinates_of<n>(state).joints_rad;
    double worst = 0;
    double fastest = 0;  // a vehicle that nothing balances turns ever faster, and errors of its attitude grow with that
    for (int tick = 0; tick < 200; ++tick) {
        dynamics::SpaceCommand<double, n> command{};
        judge::SpaceCommands given{{}, Eigen::VectorXd(n)};
        for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
            given.thrust_n.push_back(command.thrust_n[i] = 4 + 0.5 * std::sin(0.1 * tick + static_cast<double>(i)));
        }
        for (int i = 0; i < n; ++i) {
            given.joints_nm[i] = command.joint_torque_nm[i] = 0.3 * std::cos(0.05 * tick + i);
        }
        for (int step = 0; step < 100; ++step) {
            state = dynamics::space_step(model, state, command, 1e-4, WindInSpace(wind));
        }
        judged = plant.after(judged, given, wind, 0.01);
        const judge::SpaceCoordinates at = judge::coordinates_of(vehicle, judged.bodies, near_rad);
        near_rad = at.joints_rad;
        worst = std::max(worst, difference<n>(at, state));
        fastest = std::max(fastest, at.body_rate_rad_s.norm());
    }
    CAPTURE(fastest);
    CHECK(worst < 1e-7 * (1 + fastest));
    CHECK(judged.energy_j == Approx(state.energy_j).epsilon(1e-8));
}

/// Velocity through the air and how much of it there is on links in slipstreams, as the planner has it.
struct WashInSpace : WindInSpace {
    WashInSpace(const Eigen::Vector3d& wind, const SpaceSlipstreams& of) : WindInSpace(wind), all(of) {}
    const SpaceSlipstreams& all;
    static constexpr bool has_wash = true;
    [[nodiscard]] const SpaceSlipstreams& slipstreams() const { return all; }
    [[nodiscard]] double wash_scale() const { return 0.9; }
};

/// The planar test robot as a robot in space.
SpaceRobot in_space(const Robot& planar) {
    ::downwash::SpacePlant plant;
    const double pitch = planar.multirotor.pitch_inertia_kg_m2;
    plant.multirotor = {planar.multirotor.mass_kg, {{{0.7 * pitch, 0, 0}, {0, pitch, 0}, {0, 0, 1.4 * pitch}}}};
    plant.drag = planar.multirotor.drag;
    SpaceLink link;
    link.body = {
        planar.arm.mass_kg,
        {{{0.1 * planar.arm.inertia_kg_m2, 0, 0}, {0, planar.arm.inertia_kg_m2, 0}, {0, 0, planar.arm.inertia_kg_m2}}}};
    link.joint_m = {planar.arm.joint_x_m, 0, planar.arm.joint_z_m};
    link.center_of_mass_m = {planar.arm.center_of_mass_m, 0, 0};
    link.drag = planar.arm.drag;
    plant.links.push_back(link);
    plant.end_effector_m = {planar.arm.length_m, 0, 0};
    int spin = 1;
    for (const Vector3& hub_m : planar.rotors.positions_m) {
        plant.rotors.push_back({hub_m, {0, 0, 1}, spin = -spin, 0.02});
    }
    plant.power_coefficient_w_n1p5 = planar.rotors.power_coefficient_w_n1p5;
    return robot_of(plant);
}

}  // namespace

TEST_CASE("Joints stay together over 20 s, and free motion keeps momentum and energy") {
    check_free_motion<0>();
    check_free_motion<1>();
    check_free_motion<2>();
    check_free_motion<3>();
}

TEST_CASE("Bodies with constraints accelerate like the generalised coordinates") {
    check_accelerations<0>();
    check_accelerations<1>();
    check_accelerations<2>();
    check_accelerations<3>();
}

TEST_CASE("Bodies with constraints fly like the generalised coordinates") {
    for (const bool has_lag : {false, true}) {
        check_flight<0>(has_lag);
        check_flight<1>(has_lag);
        check_flight<2>(has_lag);
        check_flight<3>(has_lag);
    }
}

TEST_CASE("Errors of constraints are found and mended") {
    Tumbling<3> t(5);
    const judge::Linkage linkage(t.vehicle);
    CHECK(linkage.errors(t.bodies).place < 1e-14);
    CHECK(linkage.errors(t.bodies).speed < 1e-13);
    const Momenta before = momenta_of(t.vehicle, t.bodies);
    t.bodies[2].position_m.x() += 1e-3;
    t.bodies[1].attitude =
        (t.bodies[1].attitude * Eigen::AngleAxisd(1e-3, Vector3d(1, 2, 3).normalized())).normalized();
    t.bodies[3].velocity_m_s.y() += 0.02;
    CHECK(linkage.errors(t.bodies).place > 5e-4);
    CHECK(linkage.errors(t.bodies).speed > 5e-3);
    linkage.project(t.bodies);
    CHECK(linkage.errors(t.bodies).place < 1e-9);
    CHECK(linkage.errors(t.bodies).speed < 1e-12);
    // Constraint forces are internal: all of the kick stays in the momentum.
    const Vector3d kick(0, 0.02 * t.vehicle.bodies[3].mass_kg, 0);
    CHECK((momenta_of(t.vehicle, t.bodies).linear - before.linear - kick).norm() < 1e-12);
}

TEST_CASE("What bodies need to accelerate gives that acceleration") {
    Random random(6);
    for (int k = 0; k < 100; ++k) {
        const SpaceRobot robot = robot_of(random_space_plant(random, 3));
        const judge::SpaceVehicle vehicle = judge::vehicle_in(calm, robot);
        const judge::BodyMotions bodies =
            judge::bodies_at(vehicle, test::coordinates_of<3>(random_space_state<3>(random, 2)));
        const auto any = [&] { return Vector3d(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)); };
        const Vector3d a = any();
        const Vector3d turn = any();
        const Eigen::VectorXd joints = any();
        const judge::Needed needed = judge::needed_for(vehicle, bodies, a, turn, joints, standard_gravity_m_s2);
        std::vector<judge::BodyLoad> loads(4);
        loads[0].force_n = needed.force_n;
        loads[0].torque_nm = needed.torque_nm;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector3d torque =
                needed.joints_nm[static_cast<Eigen::Index>(i)] * (bodies[i].attitude * vehicle.joints[i].axis);
            loads[i + 1].torque_nm += torque;
            loads[i].torque_nm -= torque;
        }
        const Eigen::VectorXd given = judge::Linkage(vehicle).accelerations(bodies, loads);
        CHECK((given.segment<3>(0) - a).norm() < 1e-9);
        CHECK((given.segment<3>(3) - turn).norm() < 1e-9);
        for (Eigen::Index i = 0; i < 3; ++i) {
            const auto b = static_cast<std::size_t>(i);
            const Vector3d relative = given.segment<3>(6 * i + 9) - given.segment<3>(6 * i + 3);
            CHECK(relative.dot(bodies[b].attitude * vehicle.joints[b].axis) == Approx(joints[i]).margin(1e-9));
        }
    }
}

TEST_CASE("Slipstreams push links in space as the planner has it") {
    Random random(8);
    double worst = 0;
    double largest = 0;
    for (int k = 0; k < 20; ++k) {
        SpaceRobot robot = robot_of(random_space_plant(random, 2));
        robot.plant.rotors.clear();
        for (int i = 0; i < 6; ++i) {
            const double angle = (30 + 60 * i) * std::numbers::pi / 180;
            robot.plant.rotors.push_back({{0.275 * std::cos(angle), 0.275 * std::sin(angle), 0.05}, {0, 0, 1}, 1, 0});
        }
        robot.min_thrust_n.assign(6, 0.2);
        robot.max_thrust_n.assign(6, 12);
        for (SpaceLink& link : robot.plant.links) {
            link.joint_m[2] = -std::abs(link.joint_m[2]) - 0.05;
            link.drag = {0.01, 0.03};
        }
        robot.plant.end_effector_m = {0.2, 0.05, -0.1};
        robot.plant.wash = WashParameters{};
        SpaceWorld world;
        world.wash_scale = -0.1;
        const judge::SpaceVehicle vehicle = judge::vehicle_in(world, robot);
        const judge::SpacePlant plant(vehicle, free_air);
        const SpaceSlipstreams streams = space_slipstreams_of(robot.plant, robot.rotor_radius_m);
        auto state = random_space_state<2>(random, 0.3);
        const std::vector<double> thrust_n(6, 6.0);
        double all_n[max_rotors] = {6, 6, 6, 6, 6, 6};
        const auto model = make_space_model<2>(robot.plant);
        const double none_nm[2] = {};
        double with[8], without[8];
        const auto spin = dynamics::rotor_spin_of(model, all_n);
        dynamics::accelerations(model, state.q, state.u, all_n, spin, none_nm, WashInSpace({0.2, 0.1, 0}, streams),
                                with);
        dynamics::accelerations(model, state.q, state.u, all_n, spin, none_nm, WindInSpace({0.2, 0.1, 0}), without);
        const judge::SpaceCoordinates at = test::coordinates_of<2>(state);
        const Eigen::VectorXd a =
            plant.accelerations(judge::bodies_at(vehicle, at), thrust_n, Eigen::VectorXd::Zero(2), {0.2, 0.1, 0});
        const Vector3d turn = at.attitude.conjugate() * Vector3d(a.segment<3>(3));
        for (int i = 0; i < 3; ++i) {
            worst = std::max({worst, std::abs(a[i] - with[i]), 0.1 * std::abs(turn[i] - with[3 + i])});
            largest = std::max({largest, std::abs(with[i] - without[i]), 0.1 * std::abs(with[3 + i] - without[3 + i])});
        }
    }
    CHECK(largest > 0.05);
    CHECK(worst < 0.03 * largest);
}

TEST_CASE("Three rows hold a planar robot in its plane") {
    Robot planar = test_robot();
    planar.multirotor.drag = {1.5, 0.04};
    planar.arm.joint_x_m = 0.05;
    planar.arm.joint_z_m = -0.07;
    const SpaceRobot robot = in_space(planar);
    const judge::SpaceVehicle vehicle = judge::vehicle_in(calm, robot);
    const judge::SpacePlant held(vehicle, free_air, judge::HeldPlane{Vector3d::Zero(), Vector3d::UnitY()});
    const judge::SpacePlant loose(vehicle, free_air);
    const World calm_plane{};
    const judge::Vehicle flat = judge::vehicle_in(calm_plane, planar);
    const judge::Surroundings flat_air(nullptr, calm_plane);
    const judge::Plant plant(flat, flat_air);

    judge::PlantState flat_state;
    flat_state.motion = {{0, 0}, {0.5, 0.2}, 0.2, -0.3, 1.2, 0.4};
    judge::SpaceCoordinates at{Vector3d::Zero(),
                               Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Vector3d::UnitY())),
                               {0.5, 0, 0.2},
                               {0, -0.3, 0},
                               Eigen::VectorXd::Constant(1, 1.2),
                               Eigen::VectorXd::Constant(1, 0.4)};
    judge::SpacePlantState state{judge::bodies_at(vehicle, at), {0, 0, 0, 0}};
    judge::SpacePlantState free_state = state;
    double worst = 0;
    double worst_error = 0;
    for (int tick = 0; tick < 200; ++tick) {
        // Rotors on the left push more than those on the right, and their drag torques do not balance.
        judge::Command command;
        judge::SpaceCommands given{{}, Eigen::VectorXd::Constant(1, 0.3 * std::sin(0.07 * tick))};
        for (std::size_t i = 0; i < 4; ++i) {
            given.thrust_n.push_back(12 + (i % 2 == 0 ? 1 : -1) + 0.5 * std::sin(0.1 * tick + static_cast<double>(i)));
            command.thrust_n[i] = given.thrust_n.back();
        }
        command.joint_torque_nm = given.joints_nm[0];
        flat_state = plant.after(flat_state, command, {0.7, -0.2}, 0.01);
        state = held.after(state, given, {0.7, 0, -0.2}, 0.01);
        free_state = loose.after(free_state, given, {0.7, 0, -0.2}, 0.01);
        const judge::BodyMotion& body = state.bodies.front();
        const Vector3d ahead = body.attitude * Vector3d::UnitX();
        const judge::SpaceCoordinates now = judge::coordinates_of(vehicle, state.bodies, at.joints_rad);
        at.joints_rad = now.joints_rad;
        const judge::Motion& m = flat_state.motion;
        worst = std::max(
            {worst, std::abs(body.position_m.x() - m.position_m.x), std::abs(body.position_m.z() - m.position_m.z),
             std::abs(std::remainder(std::atan2(-ahead.z(), ahead.x()) - m.pitch_rad, 2 * std::numbers::pi)),
             std::abs(now.joints_rad[0] - m.arm_rad), std::abs(now.joint_rates_rad_s[0] - m.arm_rate_rad_s)});
        worst_error = std::max({worst_error, held.linkage().errors(state.bodies).place, std::abs(body.position_m.y())});
    }
    CHECK(worst < 1e-6);
    CHECK(worst_error < 1e-12);
    CHECK(std::abs(free_state.bodies.front().position_m.y()) > 0.1);  // it is the rows that hold it
    CHECK(state.energy_j == Approx(flat_state.energy_j).epsilon(1e-9));
}
