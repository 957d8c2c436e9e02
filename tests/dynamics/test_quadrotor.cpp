#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/dynamics/quadrotor.hpp"
#include "random_space_plant.hpp"

// The quadrotor against the equations of thesis chapter 4, written out here by themselves with Euler angles.

using namespace downwash;
using namespace downwash::test;

namespace {

QuadrotorParameters sample_quadrotor() {
    QuadrotorParameters q;
    q.mass_kg = 1.5;
    q.inertia_kg_m2 = {0.02, 0.024, 0.041};
    q.arm_m = 0.24;
    q.rotor_height_m = 0;
    q.drag_torque_m = 0.016;
    q.thrust_coefficient_n_s2 = 1.1e-5;
    q.rotor_inertia_kg_m2 = 6e-5;
    q.power_coefficient_w_n1p5 = 6;
    return q;
}

/// Ceiling at 1 m: K of thesis (2.18)'s kind, any smooth function does.
double ceiling_ratio(double distance_m) {
    return 1 + 0.02 / (distance_m * distance_m);
}
constexpr double ceiling_m = 1.0;
struct Ceiling : FreeSpace {
    [[nodiscard]] double thrust_ratio(int /*rotor*/, const dynamics::LaneVector<double>& hub_m,
                                      const dynamics::LaneVector<double>& /*axis*/) const {
        return ceiling_ratio(ceiling_m - hub_m.z);
    }
};

/// x, y, z, their rates, roll, pitch, yaw, body rates p, q, r.
using Twelve = std::array<double, 12>;

/// Thesis (4.9) to (4.14), mended: body rates in place of the rates of Euler angles, which are the same only at small
/// angles; the pitch row with (Iz - Ix) / Iy; s_phi c_psi with its sign; the lever once; the rotor distances of all
/// four rotors; and Omega counted counterclockwise, against the yaw torque of each rotor.
Twelve thesis_rates(const QuadrotorParameters& p, const Twelve& s, const double (&thrust_n)[4]) {
    const double roll = s[6];
    const double pitch = s[7];
    const double yaw = s[8];
    const double sf = std::sin(roll);
    const double cf = std::cos(roll);
    const double st = std::sin(pitch);
    const double ct = std::cos(pitch);
    const double sp = std::sin(yaw);
    const double cp = std::cos(yaw);
    const double lever = p.arm_m / std::sqrt(2.0);
    const double z_c = ceiling_m - s[2];
    const double distance[4] = {z_c - lever * (st - ct * sf), z_c + lever * (st - ct * sf),
                                z_c - lever * (st + ct * sf), z_c + lever * (st + ct * sf)};
    double k_t[4];
    double speed[4];
    for (int i = 0; i < 4; ++i) {
        k_t[i] = ceiling_ratio(distance[i]) * thrust_n[i];
        speed[i] = std::sqrt(thrust_n[i] / p.thrust_coefficient_n_s2);
    }
    const double total = k_t[0] + k_t[1] + k_t[2] + k_t[3];
    const double roll_torque = lever * (-k_t[0] + k_t[1] + k_t[2] - k_t[3]);
    const double pitch_torque = lever * (k_t[0] - k_t[1] + k_t[2] - k_t[3]);
    const double yaw_torque = p.drag_torque_m * (thrust_n[0] + thrust_n[1] - thrust_n[2] - thrust_n[3]);
    const double omega = -speed[0] - speed[1] + speed[2] + speed[3];
    const auto [ix, iy, iz] = p.inertia_kg_m2;
    const double jr = p.rotor_inertia_kg_m2;
    const double wx = s[9];
    const double wy = s[10];
    const double wz = s[11];
    return {s[3],
            s[4],
            s[5],
            (cf * st * cp + sf * sp) * total / p.mass_kg,
            (cf * st * sp - sf * cp) * total / p.mass_kg,
            cf * ct * total / p.mass_kg - 9.80665,
            wx + (sf * wy + cf * wz) * st / ct,
            cf * wy - sf * wz,
            (sf * wy + cf * wz) / ct,
            wy * wz * (iy - iz) / ix - jr / ix * wy * omega + roll_torque / ix,
            wx * wz * (iz - ix) / iy + jr / iy * wx * omega + pitch_torque / iy,
            wx * wy * (ix - iy) / iz + yaw_torque / iz};
}

Twelve thesis_step(const QuadrotorParameters& p, const Twelve& s, const double (&thrust_n)[4], double dt_s) {
    const auto moved = [&](const Twelve& by, double h) {
        Twelve to = s;
        for (std::size_t i = 0; i < 12; ++i) {
            to[i] += h * by[i];
        }
        return to;
    };
    const Twelve k1 = thesis_rates(p, s, thrust_n);
    const Twelve k2 = thesis_rates(p, moved(k1, dt_s / 2), thrust_n);
    const Twelve k3 = thesis_rates(p, moved(k2, dt_s / 2), thrust_n);
    const Twelve k4 = thesis_rates(p, moved(k3, dt_s), thrust_n);
    Twelve next = s;
    for (std::size_t i = 0; i < 12; ++i) {
        next[i] += dt_s / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    return next;
}

/// Yaw about z, then pitch about y, then roll about x.
Eigen::Quaterniond quaternion_of(double roll, double pitch, double yaw) {
    using Eigen::AngleAxisd;
    using Eigen::Vector3d;
    return AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
           AngleAxisd(roll, Vector3d::UnitX());
}

double difference(const Twelve& euler, const dynamics::SpaceState<double, 0>& state) {
    double worst = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        worst = std::max({worst, std::abs(euler[i] - state.q[i]), std::abs(euler[3 + i] - state.u[i]),
                          std::abs(euler[9 + i] - state.u[3 + i])});
    }
    const Eigen::Quaterniond attitude(state.q[3], state.q[4], state.q[5], state.q[6]);
    return std::max(worst, attitude.angularDistance(quaternion_of(euler[6], euler[7], euler[8])));
}

/// Two seconds of a flight that rolls, pitches and yaws below the ceiling.
double difference_to_thesis(double dt_s) {
    const QuadrotorParameters parameters = sample_quadrotor();
    const SpaceModel<0> model = make_space_model<0>(make_quadrotor(parameters));
    Twelve euler{0.1, -0.2, 0.3, 0.4, -0.3, 0.5, 0.15, -0.1, 0.7, 0.4, -0.3, 1.5};
    dynamics::SpaceState<double, 0> state{};
    const Eigen::Quaterniond attitude = quaternion_of(0.15, -0.1, 0.7);
    const double q[7] = {0.1, -0.2, 0.3, attitude.w(), attitude.x(), attitude.y(), attitude.z()};
    const double u[6] = {0.4, -0.3, 0.5, 0.4, -0.3, 1.5};
    std::copy(q, q + 7, state.q);
    std::copy(u, u + 6, state.u);
    double worst = 0;
    double greatest_tilt = 0;
    const int steps = static_cast<int>(std::lround(2 / dt_s));
    for (int i = 0; i < steps; ++i) {
        const double t = i * dt_s;
        // Enough to stay below the ceiling and to keep away from a pitch of 90 degrees.
        const double even = 3.0 - 0.5 * state.u[2];
        const double a = 0.10 * std::sin(6 * t) - 0.15 * (euler[6] + 0.3 * euler[9]);
        const double b = 0.12 * std::cos(5 * t) - 0.15 * (euler[7] + 0.3 * euler[10]);
        const double thrust_n[4] = {even - a + b + 0.1, even + a - b + 0.1, even + a + b - 0.1, even - a - b - 0.1};
        dynamics::SpaceCommand<double, 0> command{};
        std::copy(thrust_n, thrust_n + 4, command.thrust_n);
        euler = thesis_step(parameters, euler, thrust_n, dt_s);
        state = dynamics::space_step(model, state, command, dt_s, Ceiling{});
        worst = std::max(worst, difference(euler, state));
        greatest_tilt = std::max({greatest_tilt, std::abs(euler[6]), std::abs(euler[7])});
    }
    CHECK(greatest_tilt > 0.15);
    return worst;
}

}  // namespace

TEST_CASE("A quadrotor flies as the mended equations of thesis chapter 4 with Euler angles say") {
    CHECK(difference_to_thesis(0.01) < 1e-5);
    CHECK(difference_to_thesis(0.001) < 1e-9);
    CHECK(difference_to_thesis(0.0002) < 1e-11);
}

TEST_CASE("The signs of roll, pitch and yaw torques are those of thesis 4.13 in both layouts") {
    for (const QuadrotorLayout layout : {QuadrotorLayout::cross, QuadrotorLayout::plus}) {
        QuadrotorParameters parameters = sample_quadrotor();
        parameters.layout = layout;
        const SpaceModel<0> model = make_space_model<0>(make_quadrotor(parameters));
        const auto wrench_of = [&](int rotor) {
            double thrust_n[max_rotors] = {};
            thrust_n[rotor] = 2;
            const double level[4] = {1, 0, 0, 0};
            return dynamics::rotor_wrench(model, dynamics::rotation_of(level), {0, 0, 0}, thrust_n, FreeSpace{});
        };
        const bool is_cross = layout == QuadrotorLayout::cross;
        const double lever = is_cross ? 0.24 / std::sqrt(2.0) : 0.24;
        const double roll[2][4] = {{0, 0, 1, -1}, {-1, 1, 1, -1}};
        const double pitch[2][4] = {{1, -1, 0, 0}, {1, -1, 1, -1}};
        const double yaw[4] = {1, 1, -1, -1};
        for (int i = 0; i < 4; ++i) {
            const auto wrench = wrench_of(i);
            CHECK(wrench.force_n.z == 2);
            CHECK(wrench.torque_nm.x == Approx(2 * lever * roll[is_cross ? 1 : 0][i]).margin(1e-15));
            CHECK(wrench.torque_nm.y == Approx(2 * lever * pitch[is_cross ? 1 : 0][i]).margin(1e-15));
            CHECK(wrench.torque_nm.z == Approx(2 * 0.016 * yaw[i]));
        }
    }
}
