#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "../support/random.hpp"
#include "downwash/dynamics/space_step.hpp"

// The two quadrotors of dynobench (github.com/quimortiz/dynobench, commit 4ddf752: models/quad3d_v0.yaml,
// quad3d_omplapp.yaml, src/quadrotor.cpp), step by step: explicit Euler of 0.01 s with all rates at the beginning of
// the step. The accelerations are our plant's in one flight and dynobench's formulas, written once more, in the other.

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double step_s = 0.01;
constexpr double gravity_m_s2 = 9.81;  // dynobench's

/// A state of dynobench: position, quaternion (x, y, z, w), velocity in world axes, body rates.
struct BenchState {
    double p[3], q[4], v[3], w[3];
};

/// q times the turn by a rotation vector, (x, y, z, w).
void turn(double q[4], const double by[3]) {
    const double angle = std::sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
    const double s = angle > 0 ? std::sin(0.5 * angle) / angle : 0.5;
    const double x = s * by[0], y = s * by[1], z = s * by[2], w = std::cos(0.5 * angle);
    const double a[4] = {q[0], q[1], q[2], q[3]};
    q[0] = a[3] * x + a[0] * w + a[1] * z - a[2] * y;
    q[1] = a[3] * y - a[0] * z + a[1] * w + a[2] * x;
    q[2] = a[3] * z + a[0] * y - a[1] * x + a[2] * w;
    q[3] = a[3] * w - a[0] * x - a[1] * y - a[2] * z;
}

/// dynobench's step under a thrust and torques.
BenchState bench_step(const BenchState& s, double mass_kg, const double inertia_kg_m2[3], double thrust_n,
                      const double torque_nm[3]) {
    BenchState next = s;
    const double* q = s.q;
    const double b3[3] = {2 * (q[0] * q[2] + q[3] * q[1]), 2 * (q[1] * q[2] - q[3] * q[0]),
                          1 - 2 * (q[0] * q[0] + q[1] * q[1])};
    const double by[3] = {step_s * s.w[0], step_s * s.w[1], step_s * s.w[2]};
    turn(next.q, by);
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        next.p[i] += step_s * s.v[i];
        next.v[i] += step_s * (thrust_n * b3[i] / mass_kg - (i == 2 ? gravity_m_s2 : 0));
        // (J w) x w
        next.w[i] += step_s / inertia_kg_m2[i] *
                     (torque_nm[i] + inertia_kg_m2[j] * s.w[j] * s.w[k] - inertia_kg_m2[k] * s.w[k] * s.w[j]);
    }
    return next;
}

/// Torques that act on the body beside its rotors.
struct Twisted : dynamics::CalmSpace {
    dynamics::LaneVector<double> torque_nm{0, 0, 0};
    template <class T, int n>
    void add_load(const T* /*q*/, const T* /*u*/, const dynamics::SpacePlaces<T, n>& /*places*/,
                  dynamics::SpaceLoad<T, n>& load) const {
        load.wrench.torque_nm = load.wrench.torque_nm + torque_nm;
    }
};

/// The same step with the accelerations of our plant.
BenchState our_step(const BenchState& s, const SpaceModel<0>& model, const double thrust_n[max_rotors],
                    const Twisted& around) {
    const double q[7] = {s.p[0], s.p[1], s.p[2], s.q[3], s.q[0], s.q[1], s.q[2]};
    const double u[6] = {s.v[0], s.v[1], s.v[2], s.w[0], s.w[1], s.w[2]};
    double du[6];
    const double no_joints[1] = {};
    dynamics::accelerations(model, q, u, thrust_n, dynamics::rotor_spin_of(model, thrust_n), no_joints, around, du);
    du[2] += standard_gravity_m_s2 - gravity_m_s2;
    BenchState next = s;
    const double by[3] = {step_s * s.w[0], step_s * s.w[1], step_s * s.w[2]};
    turn(next.q, by);
    for (int i = 0; i < 3; ++i) {
        next.p[i] += step_s * s.v[i];
        next.v[i] += step_s * du[i];
        next.w[i] += step_s * du[3 + i];
    }
    return next;
}

double difference(const BenchState& a, const BenchState& b) {
    double worst = 0;
    for (int i = 0; i < 3; ++i) {
        worst = std::max({worst, std::abs(a.p[i] - b.p[i]), std::abs(a.v[i] - b.v[i]), std::abs(a.w[i] - b.w[i])});
    }
    for (int i = 0; i < 4; ++i) {
        worst = std::max(worst, std::abs(a.q[i] - b.q[i]));
    }
    return worst;
}

SpacePlant body(double mass_kg, const double inertia_kg_m2[3]) {
    SpacePlant plant;
    plant.multirotor = {mass_kg, {{{inertia_kg_m2[0], 0, 0}, {0, inertia_kg_m2[1], 0}, {0, 0, inertia_kg_m2[2]}}}};
    return plant;
}

/// Turned by 175 degrees about x, where the problems called recovery start.
const double half_angle_rad = 87.5 * std::numbers::pi / 180;
const BenchState upside_down{
    {0, 0, 1}, {-std::sin(half_angle_rad), 0, 0, std::cos(half_angle_rad)}, {0, 0, 0}, {0, 0, 0}};

}  // namespace

TEST_CASE("Our plant is quadrotor_v0 of dynobench, step by step") {
    constexpr double mass_kg = 0.034;
    constexpr double inertia_kg_m2[3] = {16.571710e-6, 16.655602e-6, 29.261652e-6};
    const double a = 0.046 / std::sqrt(2.0);
    SpacePlant plant = body(mass_kg, inertia_kg_m2);
    // tau_x = a (-f1 - f2 + f3 + f4), tau_y = a (-f1 + f2 + f3 - f4), tau_z = 0.006 (-f1 + f2 - f3 + f4)
    plant.rotors = {{{a, -a, 0}, {0, 0, 1}, 1, 0.006},
                    {{-a, -a, 0}, {0, 0, 1}, -1, 0.006},
                    {{-a, a, 0}, {0, 0, 1}, 1, 0.006},
                    {{a, a, 0}, {0, 0, 1}, -1, 0.006}};
    const SpaceModel<0> model = make_space_model<0>(plant);
    Random random(2);
    BenchState theirs = upside_down, ours = upside_down;
    double turned = 0;
    for (int step = 0; step < 500; ++step) {
        double f[max_rotors] = {};
        for (int i = 0; i < 4; ++i) {
            // Mostly alike, against the spin, so that 500 steps stay within some turns per second.
            const double control = 0.8 + random.uniform(-0.02, 0.02) + (i == step / 50 % 4 ? 0.01 : 0);
            f[i] = control * mass_kg * gravity_m_s2 / 4;
        }
        const double torque_nm[3] = {a * (-f[0] - f[1] + f[2] + f[3]), a * (-f[0] + f[1] + f[2] - f[3]),
                                     0.006 * (-f[0] + f[1] - f[2] + f[3])};
        theirs = bench_step(theirs, mass_kg, inertia_kg_m2, f[0] + f[1] + f[2] + f[3], torque_nm);
        ours = our_step(ours, model, f, {});
        turned = std::max(turned, std::abs(theirs.w[0]));
        REQUIRE(difference(ours, theirs) < 1e-9 * (1 + std::abs(theirs.p[2]) + turned));
    }
    CHECK(turned > 1);
}

TEST_CASE("Our plant is quadrotor_v1 of dynobench, step by step") {
    constexpr double mass_kg = 1;
    constexpr double inertia_kg_m2[3] = {1, 1, 1};
    SpacePlant plant = body(mass_kg, inertia_kg_m2);
    plant.rotors = {{{0, 0, 0}, {0, 0, 1}, 1, 0}};  // thrust and torques are its controls
    const SpaceModel<0> model = make_space_model<0>(plant);
    Random random(3);
    BenchState theirs = upside_down, ours = upside_down;
    double turned = 0;
    for (int step = 0; step < 500; ++step) {
        double thrust_n[max_rotors] = {random.uniform(0, 1.5) * mass_kg * gravity_m_s2};
        double torque_nm[3];
        Twisted around;
        for (double& torque : torque_nm) {
            torque = 20 * random.uniform(-2, 2);
        }
        around.torque_nm = {torque_nm[0], torque_nm[1], torque_nm[2]};
        theirs = bench_step(theirs, mass_kg, inertia_kg_m2, thrust_n[0], torque_nm);
        ours = our_step(ours, model, thrust_n, around);
        turned = std::max(turned, std::abs(theirs.w[2]));
        REQUIRE(difference(ours, theirs) < 1e-10 * (1 + std::abs(theirs.p[2]) + turned));
    }
    CHECK(turned > 1);
}
