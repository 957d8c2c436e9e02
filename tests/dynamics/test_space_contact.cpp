#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/test_robot.hpp"
#include "downwash/dynamics/ceiling_tick.hpp"
#include "downwash/dynamics/contact_step.hpp"
#include "downwash/dynamics/space_contact_step.hpp"
#include "random_space_plant.hpp"
#include "space_energy.hpp"

// Points of the multirotor and of links that touch plane surfaces in space.

using namespace downwash;
using namespace downwash::test;
using dynamics::LaneVector;
using dynamics::SpaceContact;
using dynamics::SpaceContactRecord;
using dynamics::SpaceContactStep;

namespace {

LaneVector<double> random_unit(Random& random) {
    const Vector3 v = random_vector(random, 1);
    const double length = std::sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
}

/// Four points of the frame, the end of the arm, and a point of its first link.
template <int n>
SpaceContact touching(Random& random) {
    SpaceContact contact;
    for (const double x : {-0.2, 0.2}) {
        for (const double y : {-0.15, 0.15}) {
            contact.point[contact.point_count++] = {-1, {x, y, 0.08}};
        }
    }
    for (const int link : {n - 1, 0}) {
        if (n > 0) {
            const Vector3 at = random_vector(random, 0.3);
            contact.point[contact.point_count++] = {link, {at[0], at[1], at[2]}};
        }
    }
    return contact;
}

template <int n>
LaneVector<double> world_point(const SpaceModel<n>& model, const dynamics::SpaceContactPoint& point, const double* q) {
    if (point.link >= 0) {
        return dynamics::link_point(model, q, point.link, point.at_m);
    }
    return LaneVector<double>{q[0], q[1], q[2]} + dynamics::rotation_of(q + 3) * point.at_m;
}

template <int n>
double energy_of(const SpaceModel<n>& model, const dynamics::SpaceState<double, n>& state) {
    const auto all = dynamics::invariants_at(model, state.q, state.u, {0, 0, 0});
    return all.kinetic_j + all.potential_j;
}

/// The load does the work of the forces at the points, wherever they are and however they move.
template <int n>
void check_power(Random& random) {
    const auto model = make_space_model<n>(random_space_plant(random, n));
    SpaceContact contact = touching<n>(random);
    const auto state = random_space_state<n>(random, 2);
    contact.normal = random_unit(random);
    contact.surface_m = {state.q[0] + 0.1, state.q[1], state.q[2]};
    const auto places = dynamics::places_at(model, state.q);
    const auto found = dynamics::space_contact_load(model, contact, state.q, state.u, places);
    double power_w =
        dot(found.load.wrench.force_n, dynamics::turned_back(places.attitude, {state.u[0], state.u[1], state.u[2]})) +
        dot(found.load.wrench.torque_nm, {state.u[3], state.u[4], state.u[5]});
    for (int i = 0; i < n; ++i) {
        power_w += found.load.joint_torque_nm[i] * state.u[6 + i];
    }
    double dq[7 + n], ahead[7 + n], behind[7 + n];
    dynamics::coordinate_rates<double, n>(state.q, state.u, dq);
    constexpr double dt_s = 1e-6;
    for (int i = 0; i < 7 + n; ++i) {
        ahead[i] = state.q[i] + dt_s * dq[i];
        behind[i] = state.q[i] - dt_s * dq[i];
    }
    double expected_w = 0;
    double normal_n = 0;
    double depth_m = -1e300;
    for (int i = 0; i < contact.point_count; ++i) {
        const auto& point = contact.point[i];
        const LaneVector<double> velocity =
            0.5 / dt_s * (world_point(model, point, ahead) - world_point(model, point, behind));
        const double depth = -dot(world_point(model, point, state.q) - contact.surface_m, contact.normal);
        depth_m = std::max(depth_m, depth);
        const double inward = -dot(velocity, contact.normal);
        const double push =
            depth > 0 ? contact.stiffness_n_m * depth * std::max(1 + contact.dissipation_s_m * inward, 0.0) : 0;
        const double slip = std::sqrt(std::max(dot(velocity, velocity) - inward * inward, 0.0));
        expected_w -= push * inward + contact.friction * push * slip * slip / std::hypot(slip, contact.slip_speed_m_s);
        normal_n += push;
    }
    CHECK(power_w == Approx(expected_w).epsilon(1e-6).margin(1e-6));
    CHECK(found.normal_n == Approx(normal_n).epsilon(1e-6).margin(1e-6));
    CHECK(found.depth_m == Approx(depth_m).margin(1e-12));
}

/// A vehicle that falls onto a tilted surface with all it may touch with.
template <int n>
void check_impact(Random& random) {
    SpacePlant plant = random_space_plant(random, n);
    plant.rotors.clear();
    plant.rotor_inertia_kg_m2 = 0;
    const auto model = make_space_model<n>(plant);
    SpaceContact contact = touching<n>(random);
    auto state = random_space_state<n>(random, 0.5);
    contact.normal = random_unit(random);
    contact.normal.z = std::abs(contact.normal.z);  // it falls towards it
    // So far that nothing touches yet; it moves towards the surface.
    double nearest_m = 1e300;
    for (int i = 0; i < contact.point_count; ++i) {
        nearest_m = std::min(nearest_m, dot(world_point(model, contact.point[i], state.q), contact.normal));
    }
    contact.surface_m = (nearest_m - 0.01) * contact.normal;
    for (int i = 0; i < 3; ++i) {
        state.u[i] = -0.5 * (i == 0 ? contact.normal.x : i == 1 ? contact.normal.y : contact.normal.z);
    }
    SpaceContactRecord record;
    const SpaceContactStep step{contact, {0, 0, 0}, record};
    const double first_j = energy_of(model, state);
    double impulse_n_s = 0;
    double deepest_m = -1;
    double before_j = first_j;
    for (int tick = 0; tick < 30; ++tick) {
        state = step(model, state, dynamics::SpaceCommand<double, n>{}, 0.01, FreeSpace{});
        impulse_n_s += record.normal_impulse_n_s;
        deepest_m = std::max(deepest_m, record.depth_m);
        double after_j = energy_of(model, state);
        for (int i = 0; i < contact.point_count; ++i) {
            const auto from_surface = world_point(model, contact.point[i], state.q) - contact.surface_m;
            const double depth_m = std::max(-dot(from_surface, contact.normal), 0.0);
            after_j += 0.5 * contact.stiffness_n_m * depth_m * depth_m;
        }
        CHECK(after_j < before_j + 1e-5);
        before_j = after_j;
    }
    CHECK(impulse_n_s > 0);
    CHECK(deepest_m > 0);
    CHECK(deepest_m < 0.01);
    CHECK(before_j < first_j - 1e-3);
}

SpaceModel<0> box_model() {
    SpacePlant plant;
    plant.multirotor = {3, {{{0.03, 0, 0}, {0, 0.04, 0}, {0, 0, 0.06}}}};
    for (const double x : {-0.3, 0.3}) {
        for (const double y : {-0.3, 0.3}) {
            plant.rotors.push_back({{x, y, 0}, {0, 0, 1}, x * y > 0 ? 1 : -1, 0});
        }
    }
    return make_space_model<0>(plant);
}

}  // namespace

TEST_CASE("The load of a contact in space does the work of its forces at its points") {
    Random random(41);
    for (int trial = 0; trial < 200; ++trial) {
        check_power<0>(random);
        check_power<1>(random);
        check_power<3>(random);
    }
}

TEST_CASE("Under a level ceiling the contact in space is that of the guards") {
    Random random(42);
    const auto model = box_model();
    dynamics::CeilingContact ceiling;
    SpaceContact contact;
    ceiling.ceiling_m = 0.1;
    contact.surface_m = {5, 7, 0.1};
    ceiling.dissipation_s_m = contact.dissipation_s_m;
    for (int i = 0; i < 6; ++i) {
        const Vector3 at = random_vector(random, 0.3);
        ceiling.point_m[ceiling.point_count++] = {at[0], at[1], at[2]};
        contact.point[contact.point_count++] = {-1, {at[0], at[1], at[2]}};
    }
    double worst = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const auto state = random_space_state<0>(random, 2);
        const auto places = dynamics::places_at(model, state.q);
        const auto expected = dynamics::ceiling_load(ceiling, state.q, state.u, places.attitude);
        const auto found = dynamics::space_contact_load(model, contact, state.q, state.u, places);
        const auto force = found.load.wrench.force_n - expected.wrench.force_n;
        const auto torque = found.load.wrench.torque_nm - expected.wrench.torque_nm;
        worst =
            std::max(worst, (std::sqrt(dot(force, force)) + std::sqrt(dot(torque, torque))) / (1 + expected.normal_n));
    }
    CHECK(worst < 1e-12);
}

TEST_CASE("In a plane the contact in space is the planar one") {
    Random random(43);
    Robot robot = test_robot();
    robot.arm.joint_x_m = 0.1;
    robot.arm.joint_z_m = -0.06;
    const PlantModel plane = plant_of(robot);
    SpacePlant plant;
    plant.multirotor = {robot.multirotor.mass_kg,
                        {{{0.17, 0, 0.01}, {0, robot.multirotor.pitch_inertia_kg_m2, 0}, {0.01, 0, 0.3}}}};
    SpaceLink link;
    link.body = {robot.arm.mass_kg, {{{0.001, 0, 0}, {0, robot.arm.inertia_kg_m2, 0}, {0, 0, 0.06}}}};
    link.joint_m = {robot.arm.joint_x_m, 0, robot.arm.joint_z_m};
    link.center_of_mass_m = {robot.arm.center_of_mass_m, 0, 0};
    plant.links.push_back(link);
    for (const Vector3& hub : robot.rotors.positions_m) {
        plant.rotors.push_back({hub, {0, 0, 1}, 1, 0});
    }
    plant.end_effector_m = {robot.arm.length_m, 0, 0};
    const auto model = make_space_model<1>(plant);
    for (const bool is_tip : {false, true}) {
        dynamics::PlanarContact planar;
        SpaceContact contact;
        planar.is_end_effector = is_tip;
        if (is_tip) {
            contact.point[contact.point_count++] = {0, {robot.arm.length_m, 0, 0}};
        } else {
            for (const double x : {-0.3, 0.3}) {
                planar.point_m[planar.point_count++] = {x, 0.1};
                contact.point[contact.point_count++] = {-1, {x, 0, 0.1}};
            }
        }
        double worst = 0;
        for (int trial = 0; trial < 500; ++trial) {
            const double angle = random.uniform(-3, 3);
            planar.normal = {std::sin(angle), std::cos(angle)};
            contact.normal = {std::sin(angle), 0, std::cos(angle)};
            double q[4], u[4];
            for (int i = 0; i < 4; ++i) {
                q[i] = random.uniform(-1, 1);
                u[i] = random.uniform(-2, 2);
            }
            planar.surface_m = {q[0], q[1]};
            contact.surface_m = {q[0], 0.4, q[1]};
            const double in_space[8] = {q[0], 0, q[1], std::cos(q[2] / 2), 0, std::sin(q[2] / 2), 0, q[3]};
            const double speeds[7] = {u[0], 0, u[1], 0, u[2], 0, u[3]};
            const auto expected = dynamics::contact_load(plane, planar, q, u, dynamics::attitude(plane, q[2], q[3]));
            const auto places = dynamics::places_at(model, in_space);
            const auto found = dynamics::space_contact_load(model, contact, in_space, speeds, places);
            const auto force = places.attitude * found.load.wrench.force_n;
            const double size = 1 + expected.normal_n;
            worst = std::max({worst, std::abs(force.x - expected.force[0]) / size, std::abs(force.y) / size,
                              std::abs(force.z - expected.force[1]) / size,
                              std::abs(found.load.wrench.torque_nm.y - expected.force[2]) / size,
                              std::abs(found.load.joint_torque_nm[0] - expected.force[3]) / size,
                              std::abs(found.depth_m - expected.depth_m)});
        }
        CHECK(worst < 1e-12);
        // And both fly against a wall in the same way.
        planar.surface_m = {is_tip ? 1.33 : 0.32, 0};
        planar.normal = {-1, 0};
        contact.surface_m = {planar.surface_m.x, 0, 0};
        contact.normal = {-1, 0, 0};
        dynamics::PlantState<double> state{{0, 0, 0.02, -0.05}, {0.3, 0, 0, 0}, {}, 0};
        dynamics::SpaceState<double, 1> same{
            {0, 0, 0, std::cos(0.01), 0, std::sin(0.01), 0, -0.05}, {0.3, 0, 0, 0, 0, 0, 0}, {}, 0};
        dynamics::PlantCommand<double> command{};
        dynamics::SpaceCommand<double, 1> also{};
        for (int i = 0; i < 4; ++i) {
            command.thrust_n[i] = also.thrust_n[i] = 12;
        }
        command.joint_torque_nm = also.joint_torque_nm[0] = -3;
        dynamics::ContactTickRecord record;
        SpaceContactRecord other;
        const dynamics::ContactStep in_plane{planar, {0, 0}, record, 0.25};
        const SpaceContactStep in_air{contact, {0, 0, 0}, other, 1, 0.25};
        double impulse_n_s = 0;
        double other_n_s = 0;
        for (int tick = 0; tick < 40; ++tick) {
            state = in_plane(plane, state, dynamics::motion_at(plane, state.q, state.u), command, 0.01, FreeAir{});
            same = in_air(model, same, also, 0.01, FreeSpace{});
            impulse_n_s += record.normal_impulse_n_s;
            other_n_s += other.normal_impulse_n_s;
        }
        CAPTURE(is_tip);
        CHECK(impulse_n_s > 0.2);
        CHECK(other_n_s == Approx(impulse_n_s).epsilon(2e-3));
        CHECK(same.q[0] == Approx(state.q[0]).margin(1e-4));
        CHECK(same.q[2] == Approx(state.q[1]).margin(1e-4));
        CHECK(same.u[0] == Approx(state.u[0]).margin(1e-3));
        CHECK(same.u[4] == Approx(state.u[2]).margin(2e-3));
    }
}

TEST_CASE("Impacts of frame and arm against surfaces of any slope lose energy, and go in by millimetres") {
    Random random(44);
    for (int trial = 0; trial < 25; ++trial) {
        CAPTURE(trial);
        check_impact<0>(random);
        check_impact<1>(random);
        check_impact<2>(random);
        check_impact<3>(random);
    }
}

TEST_CASE("Far from a surface a tick is one step, the same as without it, and near it more steps change little") {
    const auto model = box_model();
    SpaceContact contact;
    contact.normal = {0, 0, -1};
    contact.surface_m = {0, 0, 1};
    for (const double x : {-0.2, 0.2}) {
        contact.point[contact.point_count++] = {-1, {x, 0, 0.1}};
    }
    dynamics::SpaceState<double, 0> state{};
    state.q[3] = 1;
    state.u[2] = 0.3;
    dynamics::SpaceCommand<double, 0> command{};
    std::fill(command.thrust_n, command.thrust_n + 4, 9.0);
    SpaceContactRecord record;
    const auto far = SpaceContactStep{contact, {0, 0, 0}, record}(model, state, command, 0.01, FreeSpace{});
    CHECK(record.steps == 1);
    CHECK(record.depth_m == Approx(-0.9));
    CHECK(record.normal_impulse_n_s == 0);
    const auto without = dynamics::space_step(model, state, command, 0.01, FreeSpace{});
    CHECK(std::equal(far.q, far.q + 7, without.q));
    CHECK(std::equal(far.u, far.u + 6, without.u));

    state.q[2] = 0.899;
    double end[2];
    double impulse[2];
    for (const int way : {0, 1}) {
        auto flying = state;
        impulse[way] = 0;
        for (int tick = 0; tick < 50; ++tick) {
            flying = SpaceContactStep{contact, {0, 0, 0}, record, 1, way == 0 ? 1 : 0.25}(model, flying, command, 0.01,
                                                                                          FreeSpace{});
            impulse[way] += record.normal_impulse_n_s;
            CHECK(record.steps > 1);
        }
        end[way] = flying.q[2];
    }
    CHECK(end[0] == Approx(end[1]).margin(1e-6));
    CHECK(impulse[0] == Approx(impulse[1]).epsilon(1e-3));
    // It rests: momentum came in with 3 kg at 0.3 m/s, and the thrust exceeds the weight.
    const double push_n = 36 - 3 * standard_gravity_m_s2;
    CHECK(impulse[1] == Approx(3 * 0.3 + push_n * 0.5).epsilon(1e-3));
    CHECK(end[1] - 0.9 == Approx(push_n / (2 * contact.stiffness_n_m)).epsilon(0.05));
}

TEST_CASE("A centre of mass that is elsewhere moves the points of the multirotor, not those of links") {
    Random random(45);
    const auto model = make_space_model<1>(random_space_plant(random, 1));
    SpaceContact contact;
    contact.normal = {0, 0, 1};
    contact.surface_m = {0, 0, -9};
    contact.point[contact.point_count++] = {-1, {0, 0, -0.3}};
    dynamics::SpaceState<double, 1> state{};
    state.q[3] = 1;
    SpaceContactRecord record;
    const dynamics::SpaceCommand<double, 1> command{};
    (void)SpaceContactStep{contact, {0, 0, 0.02}, record}(model, state, command, 0.01, FreeSpace{});
    CHECK(record.depth_m == Approx(-(9 - 0.32)));
    contact.point[0] = {0, {0, 0, -0.3}};
    (void)SpaceContactStep{contact, {0, 0, 0.02}, record}(model, state, command, 0.01, FreeSpace{});
    CHECK(record.depth_m == Approx(-(9 - 0.3 + model.link[0].joint_m.z)));
}

TEST_CASE(
    "On a slope steeper than its friction a body slides with the rest of its weight, on a flatter one it creeps") {
    const auto model = box_model();
    for (const double slope_rad : {0.7, 0.3}) {
        SpaceContact contact;
        contact.normal = {std::sin(slope_rad), 0, std::cos(slope_rad)};
        for (const double x : {-0.3, 0.3}) {
            for (const double y : {-0.3, 0.3}) {
                contact.point[contact.point_count++] = {-1, {x, y, -0.02}};
            }
        }
        dynamics::SpaceState<double, 0> state{};
        state.q[0] = 0.0199 * std::sin(slope_rad);
        state.q[2] = 0.0199 * std::cos(slope_rad);
        state.q[3] = std::cos(slope_rad / 2);
        state.q[5] = std::sin(slope_rad / 2);
        SpaceContactRecord record;
        for (int tick = 0; tick < 100; ++tick) {
            state = SpaceContactStep{contact, {0, 0, 0}, record}(model, state, dynamics::SpaceCommand<double, 0>{},
                                                                 0.01, FreeSpace{});
        }
        const double speed_m_s = state.u[0] * std::cos(slope_rad) - state.u[2] * std::sin(slope_rad);
        const double down = standard_gravity_m_s2 * std::sin(slope_rad);
        const double rub = 0.5 * standard_gravity_m_s2 * std::cos(slope_rad);
        CAPTURE(slope_rad);
        if (down > rub) {
            CHECK(speed_m_s == Approx(down - rub).epsilon(0.02));
        } else {
            // mu N v / sqrt(v^2 + slip^2) = m g sin
            const double share = down / rub;
            CHECK(speed_m_s == Approx(0.02 * share / std::sqrt(1 - share * share)).epsilon(1e-3));
        }
    }
}
