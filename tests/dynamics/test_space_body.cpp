#include <catch2/catch.hpp>

#include "random_space_plant.hpp"
#include "space_energy.hpp"
#include "space_newton_euler.hpp"

using namespace downwash;
using namespace downwash::test;
using dynamics::LaneVector;

namespace {

Eigen::Vector3d eigen(const LaneVector<double>& v) {
    return {v.x, v.y, v.z};
}

/// Greatest difference between forces given and those that the other algorithm finds behind their accelerations.
template <int n>
double newton_euler_error(std::uint64_t seed) {
    Random random(seed);
    double worst = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const SpacePlant plant = random_space_plant(random, n);
        const SpaceModel<n> model = make_space_model<n>(plant);
        const auto state = random_space_state<n>(random, 5);
        const Vector3 force = random_vector(random, 30);
        const Vector3 torque = random_vector(random, 3);
        const dynamics::SpaceWrench<double> wrench{{force[0], force[1], force[2]}, {torque[0], torque[1], torque[2]}};
        double joint_torques[room_for<n>] = {};
        for (double& joint_torque : joint_torques) {
            joint_torque = random.uniform(-3, 3);
        }
        const auto places = dynamics::places_at(model, state.q);
        const auto equations = dynamics::equations_of_motion(model, places, state.u);
        double du[6 + n];
        dynamics::forward_dynamics(model, places, equations, wrench, joint_torques, du);
        const SpaceForces found = space_newton_euler_forces(plant, state.q, state.u, du);
        worst = std::max(worst, (found.force_n - eigen(places.attitude * wrench.force_n)).norm());
        worst = std::max(worst, (found.torque_nm - eigen(places.attitude * wrench.torque_nm)).norm());
        for (int i = 0; i < n; ++i) {
            worst = std::max(worst, std::abs(found.joint_torques_nm[static_cast<std::size_t>(i)] - joint_torques[i]));
        }
    }
    return worst;
}

/// The greatest relative drifts over ten seconds of free motion.
struct Drift {
    double energy;    ///< kinetic and potential, over the kinetic energy reached
    double internal;  ///< kinetic less that of the common centre of mass
    double momentum, spin, place;
};

double internal_energy(const dynamics::SpaceInvariants<double>& all, double mass_kg) {
    return all.kinetic_j - 0.5 * dot(all.momentum_n_s, all.momentum_n_s) / mass_kg;
}

template <int n>
Drift free_motion_drift(std::uint64_t seed, double dt_s) {
    Random random(seed);
    SpacePlant plant = random_space_plant(random, n);
    const SpaceModel<n> model = make_space_model<n>(plant);
    auto state = random_space_state<n>(random, 2);
    const LaneVector<double> no_spin{0, 0, 0};
    const auto first = dynamics::invariants_at(model, state.q, state.u, no_spin);
    const Eigen::Vector3d gravity(0, 0, -9.80665);
    Drift drift{};
    const int steps_per_check = static_cast<int>(std::lround(0.1 / dt_s));
    for (int i = 1; i <= 100; ++i) {
        state = flown(model, state, dynamics::SpaceCommand<double, n>{}, dt_s, steps_per_check);
        const double t = 0.1 * i;
        const auto now = dynamics::invariants_at(model, state.q, state.u, no_spin);
        const Eigen::Vector3d momentum = eigen(first.momentum_n_s) + model.total_mass_kg * t * gravity;
        const Eigen::Vector3d place =
            eigen(first.center_of_mass_m) + t / model.total_mass_kg * eigen(first.momentum_n_s) + 0.5 * t * t * gravity;
        const double energy = now.kinetic_j + now.potential_j - first.kinetic_j - first.potential_j;
        drift.energy = std::max(drift.energy, std::abs(energy) / now.kinetic_j);
        const double internal = internal_energy(first, model.total_mass_kg);
        drift.internal =
            std::max(drift.internal, std::abs(internal_energy(now, model.total_mass_kg) - internal) / internal);
        drift.momentum =
            std::max(drift.momentum, (eigen(now.momentum_n_s) - momentum).norm() / eigen(first.momentum_n_s).norm());
        drift.spin =
            std::max(drift.spin, (eigen(now.angular_momentum_nm_s) - eigen(first.angular_momentum_nm_s)).norm() /
                                     eigen(first.angular_momentum_nm_s).norm());
        drift.place = std::max(drift.place, (eigen(now.center_of_mass_m) - place).norm() / place.norm());
    }
    return drift;
}

template <int n>
void check_conservation() {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Drift drift = free_motion_drift<n>(seed, 0.0005);
        CAPTURE(n, seed);
        CHECK(drift.energy < 1e-9);
        CHECK(drift.internal < 1e-9);
        CHECK(drift.momentum < 1e-9);
        CHECK(drift.spin < 1e-9);
        CHECK(drift.place < 1e-9);
    }
}

}  // namespace

TEST_CASE("In space the recursive Newton-Euler algorithm finds the forces behind the accelerations") {
    CHECK(newton_euler_error<0>(1) < 1e-10);
    CHECK(newton_euler_error<1>(2) < 1e-10);
    CHECK(newton_euler_error<2>(3) < 1e-10);
    CHECK(newton_euler_error<3>(4) < 1e-10);
    CHECK(newton_euler_error<5>(5) < 1e-10);
}

TEST_CASE("Ten seconds of free motion in space keep energy, momentum and angular momentum") {
    check_conservation<0>();
    check_conservation<1>();
    check_conservation<2>();
    check_conservation<3>();
}

TEST_CASE("Energies of a plant in space are those of its bodies one by one") {
    Random random(11);
    for (int trial = 0; trial < 200; ++trial) {
        const SpacePlant plant = random_space_plant(random, 2);
        const SpaceModel<2> model = make_space_model<2>(plant);
        const auto state = random_space_state<2>(random, 5);
        const auto all = dynamics::invariants_at(model, state.q, state.u, {0.1, 0.2, 0.3});
        // Velocities by differences of places over a short time: of each body's centre of mass.
        const auto places_after = [&](double t_s) {
            double q[9];
            double dq[9];
            dynamics::coordinate_rates<double, 2>(state.q, state.u, dq);
            for (int i = 0; i < 9; ++i) {
                q[i] = state.q[i] + t_s * dq[i];
            }
            const auto p = dynamics::places_at(model, q);
            const Eigen::Vector3d base(q[0], q[1], q[2]);
            return std::array<Eigen::Vector3d, 3>{base, base + eigen(p.attitude * p.center_m[0]),
                                                  base + eigen(p.attitude * p.center_m[1])};
        };
        const auto before = places_after(-1e-5);
        const auto at = places_after(0);
        const auto after = places_after(1e-5);
        const auto p = dynamics::places_at(model, state.q);
        const double masses[] = {plant.multirotor.mass_kg, plant.links[0].body.mass_kg, plant.links[1].body.mass_kg};
        LaneVector<double> rate{state.u[3], state.u[4], state.u[5]};
        double kinetic = 0.5 * dot(rate, model.inertia_kg_m2 * rate);
        double potential = 0;
        Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
        Eigen::Vector3d about_origin =
            eigen(p.attitude * (model.inertia_kg_m2 * rate + LaneVector<double>{0.1, 0.2, 0.3}));
        for (std::size_t i = 0; i < 3; ++i) {
            const Eigen::Vector3d velocity = (after[i] - before[i]) / 2e-5;
            kinetic += 0.5 * masses[i] * velocity.squaredNorm();
            potential += 9.80665 * masses[i] * at[i].z();
            momentum += masses[i] * velocity;
            about_origin += masses[i] * at[i].cross(velocity);
        }
        for (int i = 0; i < 2; ++i) {
            rate = rate + state.u[6 + i] * p.axis[i];
            const LaneVector<double> spin = p.inertia_kg_m2[i] * rate;
            kinetic += 0.5 * dot(rate, spin);
            about_origin += eigen(p.attitude * spin);
        }
        CHECK(all.kinetic_j == Approx(kinetic).epsilon(1e-7));
        CHECK(all.potential_j == Approx(potential).margin(1e-9));
        CHECK((eigen(all.momentum_n_s) - momentum).norm() < 1e-7);
        const Eigen::Vector3d about_center = about_origin - eigen(all.center_of_mass_m).cross(momentum);
        CHECK((eigen(all.angular_momentum_nm_s) - about_center).norm() < 1e-7);
    }
}

TEST_CASE("The end effector of an arm of two links is where plane geometry puts it") {
    // Both joints turn about y, 0.1 m below the centre of mass and 0.5 m out along the first link.
    SpacePlant plant;
    const Matrix3 inertia{{{0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}}};
    plant.multirotor = {1, inertia};
    plant.links.push_back({{0.1, inertia}, {0, 0, -0.1}, {0, 2, 0}, {0.2, 0, 0}});
    plant.links.push_back({{0.1, inertia}, {0.5, 0, 0}, {0, 1, 0}, {0.2, 0, 0}});
    const auto model = make_space_model<2>(plant);
    // Yawed by a quarter turn: body x is world y.
    const double q[9] = {1, 2, 3, std::sqrt(0.5), 0, 0, std::sqrt(0.5), 0.3, 0.4};
    const auto tip = dynamics::link_point(model, q, 1, LaneVector<double>{0.4, 0, 0});
    CHECK(tip.x == Approx(1));
    CHECK(tip.y == Approx(2 + 0.5 * std::cos(0.3) + 0.4 * std::cos(0.7)));
    CHECK(tip.z == Approx(3 - 0.1 - 0.5 * std::sin(0.3) - 0.4 * std::sin(0.7)));
    const auto elbow = dynamics::link_point(model, q, 0, LaneVector<double>{0.5, 0, 0});
    CHECK(elbow.y == Approx(2 + 0.5 * std::cos(0.3)));
    CHECK(elbow.z == Approx(3 - 0.1 - 0.5 * std::sin(0.3)));
}

TEST_CASE("A fast spin about the axis of the middle inertia turns over, as the racket of Dzhanibekov does") {
    SpacePlant plant;
    plant.multirotor = {1, {{{0.01, 0, 0}, {0, 0.02, 0}, {0, 0, 0.028}}}};
    const auto model = make_space_model<0>(plant);
    dynamics::SpaceState<double, 0> state{};
    state.q[3] = 1;
    state.u[3] = 1e-3;
    state.u[4] = 8;
    double least = 8;
    for (int i = 0; i < 1000; ++i) {
        state = flown(model, state, dynamics::SpaceCommand<double, 0>{}, 0.001, 10);
        least = std::min(least, state.u[4]);
    }
    CHECK(least < -7.9);
    // Free fall meanwhile.
    CHECK(state.q[2] == Approx(-0.5 * 9.80665 * 100));
}
