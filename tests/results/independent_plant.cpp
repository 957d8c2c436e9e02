#include "independent_plant.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace downwash::test {
namespace {

using Vector4 = std::array<double, 4>;
using Matrix4 = std::array<Vector4, 4>;

constexpr double gravity_m_s2 = 9.80665;

/// Gaussian elimination with pivots.
Vector4 solved(Matrix4 a, Vector4 b) {
    for (std::size_t i = 0; i < 4; ++i) {
        std::size_t pivot = i;
        for (std::size_t k = i + 1; k < 4; ++k) {
            pivot = std::abs(a[k][i]) > std::abs(a[pivot][i]) ? k : pivot;
        }
        std::swap(a[i], a[pivot]);
        std::swap(b[i], b[pivot]);
        for (std::size_t k = i + 1; k < 4; ++k) {
            const double scale = a[k][i] / a[i][i];
            for (std::size_t j = i; j < 4; ++j) {
                a[k][j] -= scale * a[i][j];
            }
            b[k] -= scale * b[i];
        }
    }
    for (std::size_t i = 4; i-- > 0;) {
        for (std::size_t j = i + 1; j < 4; ++j) {
            b[i] -= a[i][j] * b[j];
        }
        b[i] /= a[i][i];
    }
    return b;
}

double dot(const std::array<double, 2>& a, const std::array<double, 2>& b) {
    return a[0] * b[0] + a[1] * b[1];
}

/// Accelerations of x, z, pitch and arm under thrust F3, pitch torque T2 and joint torque.
Vector4 accelerations(const Robot& robot, const PlantVector& s, double f3, double t2, double tau7) {
    const double sin5 = std::sin(s[2]);
    const double cos5 = std::cos(s[2]);
    const double a = s[2] + s[3];
    const double ma = robot.multirotor.mass_kg;
    const double mb = robot.arm.mass_kg;
    const double ia = robot.multirotor.pitch_inertia_kg_m2;
    const double ib = robot.arm.inertia_kg_m2;
    const double lb = robot.arm.center_of_mass_m;
    const std::array r{cos5 * robot.arm.joint_x_m + sin5 * robot.arm.joint_z_m,
                       -sin5 * robot.arm.joint_x_m + cos5 * robot.arm.joint_z_m};
    const std::array e{std::cos(a), -std::sin(a)};
    const std::array ea{-lb * std::sin(a), -lb * std::cos(a)};
    const std::array j{r[1] + ea[0], -r[0] + ea[1]};
    const double m = ma + mb;
    const double m57 = ib + mb * dot(ea, j);
    const Matrix4 mass{{{m, 0, mb * j[0], mb * ea[0]},
                        {0, m, mb * j[1], mb * ea[1]},
                        {mb * j[0], mb * j[1], ia + ib + mb * dot(j, j), m57},
                        {mb * ea[0], mb * ea[1], m57, ib + mb * lb * lb}}};
    const double u5 = s[6];
    const double ua = s[6] + s[7];
    const std::array ac{-r[0] * u5 * u5 - lb * e[0] * ua * ua, -r[1] * u5 * u5 - lb * e[1] * ua * ua};
    const std::array k{mb * ac[0], mb * (ac[1] + gravity_m_s2)};
    return solved(
        mass, {f3 * sin5 - mb * ac[0], f3 * cos5 - mb * ac[1] - m * gravity_m_s2, t2 - dot(j, k), tau7 - dot(ea, k)});
}

PlantVector rate(const Robot& robot, const RotorFactor& factor, const PlantVector& s, const HeldCommand& command) {
    const RotorParameters& rotors = robot.rotors;
    const bool lags = rotors.time_constant_s > 0;
    PlantVector d(s.size(), 0.0);
    double f3 = 0;
    double t2 = 0;
    for (std::size_t i = 0; i < rotors.positions_m.size(); ++i) {
        const Vector3& p = rotors.positions_m[i];
        const double thrust_n = lags ? s[9 + i] : command.rotor_n[i];
        const double k = factor(i, s[0] + std::cos(s[2]) * p[0] + std::sin(s[2]) * p[2],
                                s[1] - std::sin(s[2]) * p[0] + std::cos(s[2]) * p[2], s[2]);
        f3 += k * thrust_n;
        t2 -= p[0] * k * thrust_n;
        d[8] += rotors.power_coefficient_w_n1p5 * std::pow(thrust_n, 1.5);
        d[9 + i] = lags ? (command.rotor_n[i] - thrust_n) / rotors.time_constant_s : 0;
    }
    d[8] += std::abs(command.arm_torque_nm * s[7]);
    const Vector4 acceleration = accelerations(robot, s, f3, t2, command.arm_torque_nm);
    for (std::size_t i = 0; i < 4; ++i) {
        d[i] = s[4 + i];
        d[4 + i] = acceleration[i];
    }
    return d;
}

PlantVector moved(PlantVector s, const PlantVector& d, double dt_s) {
    for (std::size_t i = 0; i < s.size(); ++i) {
        s[i] += dt_s * d[i];
    }
    return s;
}

}  // namespace

PlantVector integrated(const Robot& robot, const RotorFactor& factor, PlantVector state, const HeldCommand& command,
                       double duration_s, int steps) {
    const double h = duration_s / steps;
    for (int step = 0; step < steps; ++step) {
        const PlantVector k1 = rate(robot, factor, state, command);
        const PlantVector k2 = rate(robot, factor, moved(state, k1, h / 2), command);
        const PlantVector k3 = rate(robot, factor, moved(state, k2, h / 2), command);
        const PlantVector k4 = rate(robot, factor, moved(state, k3, h), command);
        for (std::size_t i = 0; i < state.size(); ++i) {
            state[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
        }
    }
    return state;
}

}  // namespace downwash::test
