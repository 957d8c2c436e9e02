#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../support/test_robot.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "downwash/effects/sided_factor.hpp"
#include "random_space_plant.hpp"
#include "space_energy.hpp"
#include "space_newton_euler.hpp"

// All that the air does to the plant in space: drag, wind, surface effects by side and tilt, fountain, walls and wash.
// In a plane it is what the plant in the plane has; anywhere it is what Newton and Euler say of the same forces in
// world axes.

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr TiltLoss tilt_loss{0.37, 0.2};
constexpr double ground_scale = 0.2;
constexpr double ceiling_scale = -0.3;
constexpr double wash_scale = 1.2;
constexpr double wall_force = 0.04;
constexpr double wall_moment_m = 0.03;
constexpr dynamics::PlanePoint<double> wind_m_s{1.7, -0.8};
/// By rotor; those that mirror each other are alike.
constexpr double thrust_scale[4] = {1.05, 0.97, 0.97, 0.92};

/// K by side that differs from rotor to rotor and from place to place.
SidedFactor<double> bump(int rotor, double x_m, double z_m) {
    const int kind = rotor == 2 ? 1 : rotor;
    const double above = 1 + (0.1 + 0.03 * kind) * std::exp(-z_m * z_m - 0.1 * x_m * x_m);
    return {above + 0.2 * std::exp(-0.5 * z_m * z_m), above};
}

double in_world(const SidedFactor<double>& level, double sine_of_tilt) {
    const SidedFactor<double> k = tilted(level, tilt_loss, sine_of_tilt);
    return k.all + (ground_scale * (k.all - 1) + (ceiling_scale - ground_scale) * (k.above - 1));
}

/// Nearness of a wall ahead at x = 4.
double nearness(double x_m) {
    return std::exp(-std::abs(4 - x_m));
}

struct AroundInPlane : dynamics::CalmSurroundings<double> {
    explicit AroundInPlane(const Slipstreams& all) : washes(all) {}
    const Slipstreams& washes;
    double thrust_ratio(int rotor, const dynamics::PlanePoint<double>& hub_m, double sin_pitch) const {
        return in_world(bump(rotor, hub_m.x, hub_m.z), sin_pitch);
    }
    double body_ratio(const dynamics::PlanePoint<double>& center_m, double sin_pitch) const {
        return in_world(bump(5, center_m.x, center_m.z), sin_pitch);
    }
    double wall_nearness(const dynamics::PlanePoint<double>& center_m) const { return nearness(center_m.x); }
    double thrust_scale(int rotor) const { return ::thrust_scale[rotor]; }
    static constexpr bool has_wind = true;
    dynamics::PlanePoint<double> wind() const { return wind_m_s; }
    static constexpr bool has_wash = true;
    [[nodiscard]] const Slipstreams& slipstreams() const { return washes; }
    double wash_scale() const { return ::wash_scale; }
};

/// The same in space, in a scene that is turned about the vertical.
struct AroundInSpace : dynamics::CalmSpace {
    explicit AroundInSpace(const SpaceSlipstreams& all, double turn_rad = 0) : washes(all), turn(turn_rad) {}
    const SpaceSlipstreams& washes;
    double turn;
    using Vector = dynamics::LaneVector<double>;

    [[nodiscard]] Vector world(const Vector& v) const { return dynamics::rotation_about(Vector{0, 0, 1}, turn) * v; }
    [[nodiscard]] Vector scene(const Vector& v) const {
        return dynamics::turned_back(dynamics::rotation_about(Vector{0, 0, 1}, turn), v);
    }
    [[nodiscard]] double thrust_ratio(int rotor, const Vector& hub_m, const Vector& axis) const {
        const Vector at = scene(hub_m);
        return in_world(bump(rotor, at.x, at.z), dynamics::sine_of_tilt(axis));
    }
    [[nodiscard]] double body_ratio(const Vector& center_m, const Vector& axis) const {
        return thrust_ratio(5, center_m, axis);
    }
    [[nodiscard]] Vector wall_nearness(const Vector& center_m) const {
        return world({nearness(scene(center_m).x), 0, 0});
    }
    [[nodiscard]] double thrust_scale(int rotor) const { return ::thrust_scale[rotor % 4]; }
    static constexpr bool has_wind = true;
    [[nodiscard]] Vector wind() const { return world({wind_m_s.x, 0, wind_m_s.z}); }
    static constexpr bool has_wash = true;
    [[nodiscard]] const SpaceSlipstreams& slipstreams() const { return washes; }
    [[nodiscard]] double wash_scale() const { return ::wash_scale; }
};

/// With one rotor before, one behind, and two beside the arm's plane.
Robot planar_robot() {
    Robot robot = test_robot();
    robot.arm.joint_x_m = 0.11;
    robot.arm.joint_z_m = -0.07;
    robot.multirotor.drag = {0.7, 0.09};
    robot.arm.drag = {0.13, 0.21};
    robot.arm.wash.emplace();
    robot.arm.wash->scale = 1.1;
    robot.rotors.time_constant_s = 0.05;
    robot.rotors.positions_m = {{0.31, 0, 0.05}, {0.06, 0.1, 0.06}, {0.06, -0.1, 0.06}, {-0.35, 0, 0.08}};
    return robot;
}

SpacePlant in_space(const Robot& robot) {
    SpacePlant plant;
    plant.multirotor = {robot.multirotor.mass_kg,
                        {{{0.17, 0, 0.01}, {0, robot.multirotor.pitch_inertia_kg_m2, 0}, {0.01, 0, 0.3}}}};
    SpaceLink link;
    link.body = {robot.arm.mass_kg, {{{0.001, 0, 0}, {0, robot.arm.inertia_kg_m2, 0}, {0, 0, 0.06}}}};
    link.joint_m = {robot.arm.joint_x_m, 0, robot.arm.joint_z_m};
    link.center_of_mass_m = {robot.arm.center_of_mass_m, 0, 0};
    link.drag = robot.arm.drag;
    plant.links.push_back(link);
    plant.end_effector_m = {robot.arm.length_m, 0, 0};
    for (const Vector3& hub : robot.rotors.positions_m) {
        plant.rotors.push_back({hub, {0, 0, 1}, 1, 0});
    }
    plant.time_constant_s = robot.rotors.time_constant_s;
    plant.power_coefficient_w_n1p5 = robot.rotors.power_coefficient_w_n1p5;
    plant.drag = robot.multirotor.drag;
    plant.wash = robot.arm.wash;
    return plant;
}

struct Both {
    Robot robot = planar_robot();
    PlantModel plane = plant_of(robot);
    SpaceModel<1> space = make_space_model<1>(in_space(robot), true);
    Slipstreams in_plane = slipstreams_of(robot.arm, robot.rotors);
    SpaceSlipstreams anywhere = space_slipstreams_of(in_space(robot), robot.rotors.radius_m);
    Both() {
        plane.has_fountain = true;
        plane.has_walls = space.has_walls = true;
        plane.wall_force = space.wall_force = wall_force;
        plane.wall_moment_m = space.wall_moment_m = wall_moment_m;
    }
};

using Planar = dynamics::PlantState<double>;
using Space = dynamics::SpaceState<double, 1>;

/// In the plane that is turned about the vertical.
Space lifted(const Planar& planar, double turn_rad) {
    const double c = std::cos(turn_rad), s = std::sin(turn_rad);
    const double half_c = std::cos(turn_rad / 2), half_s = std::sin(turn_rad / 2);
    const double pitch_c = std::cos(planar.q[2] / 2), pitch_s = std::sin(planar.q[2] / 2);
    Space space{{c * planar.q[0], s * planar.q[0], planar.q[1], half_c * pitch_c, -half_s * pitch_s, half_c * pitch_s,
                 half_s * pitch_c, planar.q[3]},
                {c * planar.u[0], s * planar.u[0], planar.u[1], 0, planar.u[2], 0, planar.u[3]},
                {},
                planar.energy_j};
    std::copy(planar.thrust_n, planar.thrust_n + max_rotors, space.thrust_n);
    return space;
}

double difference_after_a_second(const Both& both, double dt_s, double turn_rad) {
    const AroundInPlane in_plane(both.in_plane);
    const AroundInSpace anywhere(both.anywhere, turn_rad);
    Planar planar{{0.2, 0.4, 0.1, 1.2}, {0.3, 0.2, -0.4, 0.8}, {9, 10, 10, 12}, 1};
    Space space = lifted(planar, turn_rad);
    double worst = 0;
    const int steps = static_cast<int>(std::lround(1 / dt_s));
    for (int i = 0; i < steps; ++i) {
        const double t = i * dt_s;
        const double beside_n = 12 - std::sin(7 * t);
        const double thrust_n[4] = {11 + std::sin(5 * t), beside_n, beside_n, 12.5};
        dynamics::PlantCommand<double> command{};
        dynamics::SpaceCommand<double, 1> same{};
        std::copy(thrust_n, thrust_n + 4, command.thrust_n);
        std::copy(thrust_n, thrust_n + 4, same.thrust_n);
        command.joint_torque_nm = same.joint_torque_nm[0] = -2 * std::cos(4 * t);
        planar = dynamics::flight_step(both.plane, planar, command, dt_s, in_plane);
        space = dynamics::space_step(both.space, space, same, dt_s, anywhere);
        const Space expected = lifted(planar, turn_rad);
        const double sign = space.q[3] * expected.q[3] + space.q[5] * expected.q[5] < 0 ? -1 : 1;
        for (int k = 0; k < 8; ++k) {
            worst = std::max(worst, std::abs((k > 2 && k < 7 ? sign : 1) * space.q[k] - expected.q[k]));
        }
        for (int k = 0; k < 7; ++k) {
            worst = std::max(worst, std::abs(space.u[k] - expected.u[k]));
        }
        worst = std::max(worst, std::abs(space.energy_j / expected.energy_j - 1));
    }
    CHECK(std::abs(planar.q[0] - 0.2) > 0.3);  // it does something
    return worst;
}

}  // namespace

TEST_CASE("In a plane the air does to the plant in space what it does to the planar one") {
    const Both both;
    CHECK(both.in_plane.count == 3);
    CHECK(both.anywhere.count == 3);
    Random random(5);
    double worst = 0;
    double greatest_change = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        Planar planar{};
        for (int i = 0; i < 4; ++i) {
            planar.q[i] = random.uniform(-3, 3);
            planar.u[i] = random.uniform(-5, 5);
            planar.thrust_n[i] = random.uniform(0, 20);
        }
        planar.thrust_n[2] = planar.thrust_n[1];
        const double turn_rad = random.uniform(-3, 3);
        const Space state = lifted(planar, turn_rad);
        const double torque_nm = random.uniform(-5, 5);
        double du[4];
        dynamics::accelerations(both.plane, planar.q, planar.u, dynamics::motion_at(both.plane, planar.q, planar.u),
                                planar.thrust_n, torque_nm, AroundInPlane(both.in_plane), du);
        double du_space[7];
        dynamics::accelerations(both.space, state.q, state.u, state.thrust_n, {0, 0, 0}, &torque_nm,
                                AroundInSpace(both.anywhere, turn_rad), du_space);
        double calm[7];
        dynamics::accelerations(both.space, state.q, state.u, state.thrust_n, {0, 0, 0}, &torque_nm, FreeSpace{}, calm);
        const double c = std::cos(turn_rad), s = std::sin(turn_rad);
        const double expected[] = {c * du[0], s * du[0], du[1], 0, du[2], 0, du[3]};
        double size = 1;
        for (const double one : expected) {
            size = std::max(size, std::abs(one));
        }
        for (int i = 0; i < 7; ++i) {
            worst = std::max(worst, std::abs(du_space[i] - expected[i]) / size);
            greatest_change = std::max(greatest_change, std::abs(calm[i] - expected[i]));
        }
    }
    CHECK(worst < 1e-12);
    CHECK(greatest_change > 10);
}

TEST_CASE("In a plane of any heading the plant in space flies through air as the planar one") {
    const Both both;
    for (const double turn_rad : {0.0, 0.7, -2.1}) {
        CAPTURE(turn_rad);
        CHECK(difference_after_a_second(both, 0.001, turn_rad) < 1e-9);
        CHECK(difference_after_a_second(both, 0.0002, turn_rad) < 1e-11);
    }
}

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d vector_of(const Vector3& v) {
    return {v[0], v[1], v[2]};
}
Vector3d vector_of(const dynamics::LaneVector<double>& v) {
    return {v.x, v.y, v.z};
}
dynamics::LaneVector<double> lanes_of(const Vector3d& v) {
    return {v[0], v[1], v[2]};
}

/// A plant with links askew that have drag and, but for the last, a way to the next joint.
SpacePlant random_airy_plant(Random& random, int joints) {
    SpacePlant plant = random_space_plant(random, joints);
    plant.rotor_inertia_kg_m2 = 0;
    plant.drag = {random.uniform(0, 1), random.uniform(0, 1)};
    plant.end_effector_m = random_vector(random, 0.5);
    for (SpaceLink& link : plant.links) {
        link.drag = {random.uniform(0, 0.3), random.uniform(0, 0.3)};
    }
    return plant;
}

/// Loads by forces at places of the world: what turns each joint is their moment about its axis.
struct WorldLoads {
    Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
    std::vector<double> joint_torques;
};

/// Where everything is, in world axes.
struct WorldArm {
    std::vector<Vector3d> joint, joint_velocity, axis, rate, end;
    Matrix3d axes;
    WorldArm(const SpacePlant& plant, const double* q, const double* u) {
        axes = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix();
        Matrix3d turned = axes;
        Vector3d at(q[0], q[1], q[2]), velocity(u[0], u[1], u[2]), turning = axes * Vector3d(u[3], u[4], u[5]);
        for (std::size_t i = 0; i < plant.links.size(); ++i) {
            const SpaceLink& link = plant.links[i];
            const Vector3d way = turned * vector_of(link.joint_m);
            velocity += turning.cross(way);
            at += way;
            const Vector3d unit = vector_of(link.axis).normalized();
            axis.push_back(turned * unit);
            turned = turned * Eigen::AngleAxisd(q[7 + i], unit).toRotationMatrix();
            turning += u[6 + i] * axis.back();
            joint.push_back(at);
            joint_velocity.push_back(velocity);
            rate.push_back(turning);
            const bool is_last = i + 1 == plant.links.size();
            end.push_back(at + turned * vector_of(is_last ? plant.end_effector_m : plant.links[i + 1].joint_m));
        }
    }
};

template <int n>
void check_against_newton_euler(Random& random, double& worst, double& greatest_n) {
    const SpacePlant plant = random_airy_plant(random, n);
    SpaceModel<n> model = make_space_model<n>(plant, true);
    model.has_walls = true;
    model.wall_force = wall_force;
    model.wall_moment_m = wall_moment_m;
    const AroundInSpace around(no_space_slipstreams, 0.4);
    const auto state = random_space_state<n>(random, 3);
    double thrust_n[max_rotors], joint_nm[room_for<n>] = {}, du[6 + n];
    for (double& thrust : thrust_n) {
        thrust = random.uniform(1, 12);
    }
    for (int i = 0; i < n; ++i) {
        joint_nm[i] = random.uniform(-1, 1);
    }
    dynamics::accelerations(model, state.q, state.u, thrust_n, {0, 0, 0}, joint_nm, around, du);
    const SpaceForces needed = space_newton_euler_forces(plant, state.q, state.u, du);

    const WorldArm arm(plant, state.q, state.u);
    const Vector3d position(state.q[0], state.q[1], state.q[2]);
    WorldLoads loads;
    loads.joint_torques.assign(joint_nm, joint_nm + n);
    const auto push = [&](int link, const Vector3d& at, const Vector3d& force) {
        loads.force += force;
        loads.torque += (at - position).cross(force);
        for (int i = 0; i <= link; ++i) {
            const auto k = static_cast<std::size_t>(i);
            loads.joint_torques[k] += arm.axis[k].dot((at - arm.joint[k]).cross(force));
        }
    };
    const auto drag = [](const DragParameters& of, const Vector3d& v) -> Vector3d {
        return -(of.linear_n_s_m + of.quadratic_n_s2_m2 * v.norm()) * v;
    };
    // Rotors, fountain and walls.
    Vector3d axes = Vector3d::Zero(), center = Vector3d::Zero();
    double free_air_n = 0;
    for (int i = 0; i < model.rotor_count; ++i) {
        const SpaceRotor& rotor = plant.rotors[static_cast<std::size_t>(i)];
        const Vector3d hub = position + arm.axes * vector_of(rotor.position_m);
        const Vector3d axis = arm.axes * vector_of(rotor.axis).normalized();
        const double acting_n = thrust_scale[i % 4] * thrust_n[i];
        push(-1, hub, around.thrust_ratio(i, lanes_of(hub), lanes_of(axis)) * acting_n * axis);
        loads.torque -= rotor.spin * rotor.drag_torque_m * thrust_n[i] * axis;
        axes += axis;
        center += hub / model.rotor_count;
        free_air_n += acting_n;
    }
    axes.normalize();
    push(-1, center, (around.body_ratio(lanes_of(center), lanes_of(axes)) - 1) * free_air_n * axes);
    const Vector3d wall = vector_of(around.wall_nearness(lanes_of(center)));
    push(-1, position, -wall_force * free_air_n * wall);
    loads.torque += wall_moment_m * free_air_n * Vector3d::UnitZ().cross(wall);
    // Drag, with the same two points on each link.
    const Vector3d wind = vector_of(around.wind());
    push(-1, position, drag(plant.drag, Vector3d(state.u[0], state.u[1], state.u[2]) - wind));
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        const Vector3d way = arm.end[i] - arm.joint[i];
        for (const double share : {0.5 - std::sqrt(1 / 12.0), 0.5 + std::sqrt(1 / 12.0)}) {
            const Vector3d stream = arm.joint_velocity[i] + arm.rate[i].cross(share * way) - wind;
            const Vector3d along = way.normalized();
            const Vector3d across = stream - stream.dot(along) * along;
            push(static_cast<int>(i), arm.joint[i] + share * way, 0.5 * drag(plant.links[i].drag, across));
        }
    }
    worst = std::max(worst, (loads.force - needed.force_n).cwiseAbs().maxCoeff());
    worst = std::max(worst, (loads.torque - needed.torque_nm).cwiseAbs().maxCoeff());
    greatest_n = std::max(greatest_n, loads.force.norm());
    for (std::size_t i = 0; i < n; ++i) {
        worst = std::max(worst, std::abs(loads.joint_torques[i] - needed.joint_torques_nm[i]));
    }
}

struct Still : dynamics::CalmSpace {
    static constexpr bool has_wind = true;
};

struct Wind : dynamics::CalmSpace {
    static constexpr bool has_wind = true;
    [[nodiscard]] dynamics::LaneVector<double> wind() const { return {1, -2, 0.5}; }
};

template <int n>
void check_energy(Random& random) {
    SpacePlant plant = random_airy_plant(random, n);
    plant.rotors.clear();
    const SpaceModel<n> model = make_space_model<n>(plant);
    auto state = random_space_state<n>(random, 5);
    const auto energy_of = [&](const auto& of) {
        const auto all = dynamics::invariants_at(model, of.q, of.u, {0, 0, 0});
        return all.kinetic_j + all.potential_j;
    };
    double before = energy_of(state);
    const double first = before;
    for (int i = 0; i < 500; ++i) {
        state = dynamics::space_step(model, state, dynamics::SpaceCommand<double, n>{}, 0.002, Still{});
        const double after = energy_of(state);
        CHECK(after < before);
        before = after;
    }
    CHECK(before < first - 0.1);
}

}  // namespace

TEST_CASE("With rotors, fountain, walls, wind and drag the forces are those of Newton and Euler in world axes") {
    Random random(31);
    double worst = 0;
    double greatest_n = 0;
    for (int trial = 0; trial < 500; ++trial) {
        check_against_newton_euler<0>(random, worst, greatest_n);
        check_against_newton_euler<1>(random, worst, greatest_n);
        check_against_newton_euler<2>(random, worst, greatest_n);
        check_against_newton_euler<3>(random, worst, greatest_n);
    }
    CHECK(greatest_n > 50);
    CHECK(worst < 1e-11);
}

TEST_CASE("In still air drag takes energy from every motion") {
    Random random(32);
    for (int trial = 0; trial < 10; ++trial) {
        check_energy<0>(random);
        check_energy<1>(random);
        check_energy<2>(random);
        check_energy<3>(random);
    }
}

TEST_CASE("In a wind a falling body without thrust comes to move with the air, at its terminal speed") {
    SpacePlant plant;
    plant.multirotor = {2, {{{0.02, 0, 0}, {0, 0.03, 0}, {0, 0, 0.04}}}};
    plant.drag = {0.5, 0.3};
    const auto model = make_space_model<0>(plant);
    dynamics::SpaceState<double, 0> state{};
    state.q[3] = 1;
    state = flown(model, state, dynamics::SpaceCommand<double, 0>{}, 0.01, 3000, Wind{});
    // 0.5 v + 0.3 v^2 = 2 g
    const double terminal_m_s = (-0.5 + std::sqrt(0.25 + 4 * 0.3 * 2 * standard_gravity_m_s2)) / 0.6;
    CHECK(state.u[0] == Approx(1).margin(1e-9));
    CHECK(state.u[1] == Approx(-2).margin(1e-9));
    CHECK(state.u[2] == Approx(0.5 - terminal_m_s).epsilon(1e-9));
}

TEST_CASE("A link without any way has drag in every direction, at its joint") {
    SpacePlant plant;
    plant.multirotor = {2, {{{0.02, 0, 0}, {0, 0.03, 0}, {0, 0, 0.04}}}};
    SpaceLink link;
    link.body = {0.5, {{{0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}}}};
    link.joint_m = {0, 0, -0.1};
    link.drag = {2, 0};
    plant.links.push_back(link);
    const auto model = make_space_model<1>(plant);
    const double q[8] = {0, 0, 0, 1, 0, 0, 0, 0}, u[7] = {1, 2, 3, 0, 0, 0, 0};
    const auto places = dynamics::places_at(model, q);
    dynamics::SpaceLoad<double, 1> load{};
    const auto streams = dynamics::link_streams(model, places, {1, 2, 3}, u);
    dynamics::add_link_forces(places, streams, dynamics::link_drag(model, streams), load);
    CHECK(load.wrench.force_n.x == Approx(-2));
    CHECK(load.wrench.force_n.y == Approx(-4));
    CHECK(load.wrench.force_n.z == Approx(-6));
    CHECK(load.wrench.torque_nm.x == Approx(-0.4));
    CHECK(load.wrench.torque_nm.y == Approx(0.2));
    CHECK(load.joint_torque_nm[0] == Approx(0).margin(1e-12));
}
