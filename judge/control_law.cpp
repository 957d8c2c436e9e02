#include "downwash/judge/control_law.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "downwash/dynamics/plant_model.hpp"

namespace downwash::judge {
namespace {

using Matrix4 = Eigen::Matrix4d;
using Vector4 = Eigen::Vector4d;

/// ki times an integral, within its limit.
double action(double ki, double limit, double integral) {
    return std::clamp(ki * integral, -limit, limit);
}

/// The integral a tick later; it never grows beyond what its limit can use. Without a gain it stays.
double integrated_by(double ki, double limit, double integral, double error, double tick_s) {
    return ki > 0 ? std::clamp(integral + error * tick_s, -limit / ki, limit / ki) : integral;
}

}  // namespace

/// The equations of motion of docs/model.md 2 at one instant: M du/dt + c = Q.
struct ControlLaw::Inversion {
    Matrix4 mass;
    Vector4 bias;
    double sine, cosine;  ///< of the pitch

    Inversion(const Vehicle& v, const Motion& seen) : sine(std::sin(seen.pitch_rad)), cosine(std::cos(seen.pitch_rad)) {
        const Planar r = from_body(v.joint_m, seen.pitch_rad);
        const Planar e = arm_direction(seen.pitch_rad, seen.arm_rad);
        const Planar ea = turned(v.arm_center_of_mass_m, e);
        const Planar both = turned(1, r) + ea;
        const double mb = v.arm_mass_kg;
        const double w = seen.pitch_rate_rad_s + seen.arm_rate_rad_s;
        const auto dot = [](Planar a, Planar b) { return a.x * b.x + a.z * b.z; };
        mass << v.mass_kg(), 0, mb * both.x, mb * ea.x,  //
            0, v.mass_kg(), mb * both.z, mb * ea.z,      //
            mb * both.x, mb * both.z, v.body_inertia_kg_m2 + v.arm_inertia_kg_m2 + mb * dot(both, both),
            v.arm_inertia_kg_m2 + mb * dot(ea, both),  //
            mb * ea.x, mb * ea.z, v.arm_inertia_kg_m2 + mb * dot(ea, both),
            v.arm_inertia_kg_m2 + mb * v.arm_center_of_mass_m * v.arm_center_of_mass_m;
        const Planar ac = -(seen.pitch_rate_rad_s * seen.pitch_rate_rad_s) * r - v.arm_center_of_mass_m * w * w * e;
        const Planar k = mb * (ac + Planar{0, standard_gravity_m_s2});
        bias << mb * ac.x, mb * ac.z + v.mass_kg() * standard_gravity_m_s2, dot(both, k), dot(ea, k);
    }
};

struct ControlLaw::Demand {
    double thrust_n, pitch_torque_nm, arm_acceleration;
};

ControlLaw::ControlLaw(const Robot& robot)
    : robot_(robot), believed_(vehicle_in({}, robot)), tick_s_(1 / robot.controller.rate_hz) {
    Eigen::MatrixXd rows(2, believed_.rotor_count);
    for (int i = 0; i < believed_.rotor_count; ++i) {
        rows(0, i) = 1;
        rows(1, i) = -believed_.hub_m[static_cast<std::size_t>(i)].x;
    }
    const Eigen::MatrixXd inverse = rows.completeOrthogonalDecomposition().pseudoInverse();
    for (int i = 0; i < believed_.rotor_count; ++i) {
        share_[static_cast<std::size_t>(i)] = {inverse(i, 0), inverse(i, 1)};
    }
}

std::array<double, max_rotors> ControlLaw::resting_thrust_n() const noexcept {
    std::array<double, max_rotors> thrust_n{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(believed_.rotor_count); ++i) {
        thrust_n[i] = share_[i][0] * believed_.mass_kg() * standard_gravity_m_s2;
    }
    return thrust_n;
}

ControlLaw::Demand ControlLaw::demanded(const Inversion& inversion, const Motion& seen, const ReferencePoint& reference,
                                        ControlMemory& kept, ControlMemory& integrated) const {
    const ModelInversion& gain = std::get<ModelInversion>(robot_.controller.law);
    const double dt = tick_s_;
    // 5.1: acceleration of x and z, and 5.2: of the arm.
    const Planar error{reference.position[0] - seen.position_m.x, reference.position[1] - seen.position_m.z};
    const double kp[] = {gain.position_kp, gain.height_kp.value_or(gain.position_kp)};
    const double kd[] = {gain.position_kd, gain.height_kd.value_or(gain.position_kd)};
    const double ki[] = {gain.position_ki, gain.height_ki.value_or(gain.position_ki)};
    const auto wanted = [&](int axis, double speed, double off, double integral) {
        return reference.acceleration[axis] + kd[axis] * (reference.velocity[axis] - speed) + kp[axis] * off +
               action(ki[axis], gain.position_integral_limit_m_s2, integral);
    };
    const double v1 = wanted(0, seen.velocity_m_s.x, error.x, kept.position_integral.x);
    const double v3 = wanted(1, seen.velocity_m_s.z, error.z, kept.position_integral.z);
    const double arm_error = reference.position[2] - seen.arm_rad;
    const double v7 = reference.acceleration[2] + gain.arm_kd * (reference.velocity[2] - seen.arm_rate_rad_s) +
                      gain.arm_kp * arm_error + action(gain.arm_ki, gain.arm_integral_limit_rad_s2, kept.arm_integral);

    // Rows 1 and 2 with (v1, v3, 0, v7).
    const Vector4 force = inversion.mass * Vector4(v1, v3, 0, v7) + inversion.bias;
    const double min_force_z = gain.min_vertical_force_ratio * believed_.mass_kg() * standard_gravity_m_s2;
    const double tilt = std::atan2(force(0), std::max(force(1), min_force_z));
    const double pitch_reference = std::clamp(tilt, -gain.max_tilt_rad, gain.max_tilt_rad);
    const bool is_clipped = std::abs(tilt) > gain.max_tilt_rad || force(1) < min_force_z;
    const double thrust = force(0) * inversion.sine + force(1) * inversion.cosine;

    // K5^-1 and D5^-1.
    const double raw_rate = (pitch_reference - kept.pitch_reference_rad) / dt;
    const double rate =
        kept.pitch_reference_rate + dt / (gain.pitch_rate_filter_s + dt) * (raw_rate - kept.pitch_reference_rate);
    const double rate_reference = rate + gain.attitude_kp * (pitch_reference - seen.pitch_rad);
    const double rate_error = rate_reference - seen.pitch_rate_rad_s;
    double v5 = gain.attitude_rate_kp * rate_error +
                action(gain.attitude_rate_ki, gain.attitude_integral_limit_rad_s2, kept.pitch_rate_integral);
    if (gain.rate_feed_forward) {
        v5 += (rate_reference - kept.rate_reference) / dt;
    }
    // Row 3, with du1 and du3 from rows 1 and 2 under this thrust.
    const Eigen::Vector2d pull(thrust * inversion.sine, thrust * inversion.cosine);
    const Eigen::Vector2d translation = inversion.mass.topLeftCorner<2, 2>().diagonal().cwiseInverse().cwiseProduct(
        pull - inversion.bias.head<2>() - inversion.mass.topRightCorner<2, 2>() * Eigen::Vector2d(v5, v7));
    const Vector4 acceleration(translation(0), translation(1), v5, v7);
    const double torque = inversion.mass.row(2) * acceleration + inversion.bias(2);

    kept.pitch_reference_rad = pitch_reference;
    kept.pitch_reference_rate = rate;
    kept.rate_reference = rate_reference;
    integrated = kept;
    if (!is_clipped) {
        const double most = gain.position_integral_limit_m_s2;
        integrated.position_integral = {integrated_by(ki[0], most, kept.position_integral.x, error.x, dt),
                                        integrated_by(ki[1], most, kept.position_integral.z, error.z, dt)};
    }
    integrated.pitch_rate_integral = integrated_by(gain.attitude_rate_ki, gain.attitude_integral_limit_rad_s2,
                                                   kept.pitch_rate_integral, rate_error, dt);
    integrated.arm_integral =
        integrated_by(gain.arm_ki, gain.arm_integral_limit_rad_s2, kept.arm_integral, arm_error, dt);
    return {thrust, torque, v7};
}

/// Allocates and clips. @return whether anything was clipped
bool ControlLaw::limit(const Inversion& inversion, const Demand& demand, const std::array<double, max_rotors>& rotor_n,
                       Command& command) const {
    const double low_n = robot_.rotors.min_thrust_n;
    const double high_n = robot_.rotors.max_thrust_n;
    const double lag_s = believed_.rotor_time_constant_s;
    const double reached = 0.5 * tick_s_ / (0.5 * tick_s_ + lag_s);  // of the way, in mid-tick
    bool is_clipped = false;
    double thrust_n = 0;
    double torque_nm = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(believed_.rotor_count); ++i) {
        const double wanted_n = share_[i][0] * demand.thrust_n + share_[i][1] * demand.pitch_torque_nm;
        is_clipped = is_clipped || wanted_n > high_n || wanted_n < low_n;
        const double lead = lag_s > 0 ? std::get<ModelInversion>(robot_.controller.law).rotor_lead : 0;
        command.thrust_n[i] = std::clamp(wanted_n + lead * (wanted_n - rotor_n[i]), low_n, high_n);
        const double now_n = lag_s > 0 ? rotor_n[i] : command.thrust_n[i];
        const double expected_n = now_n + reached * (command.thrust_n[i] - now_n);
        thrust_n += expected_n;
        torque_nm -= believed_.hub_m[i].x * expected_n;
    }
    // The four rows for du1, du3, du5 and the joint torque, with du7 given.
    Matrix4 m = inversion.mass;
    m.col(3) << 0, 0, 0, -1;
    const Vector4 load(thrust_n * inversion.sine, thrust_n * inversion.cosine, torque_nm, 0);
    const Vector4 x = m.partialPivLu().solve(load - inversion.bias - demand.arm_acceleration * inversion.mass.col(3));
    const double most_nm = robot_.arm.max_torque_nm;
    command.joint_torque_nm = std::clamp(x(3), -most_nm, most_nm);
    return is_clipped || std::abs(x(3)) > most_nm;
}

Command ControlLaw::command(const Motion& seen, const std::array<double, max_rotors>& rotor_n,
                            const ReferencePoint& reference, ControlMemory& memory) const {
    const Inversion inversion(believed_, seen);
    ControlMemory kept = memory;
    ControlMemory integrated;
    const Demand demand = demanded(inversion, seen, reference, kept, integrated);
    Command command;
    memory = limit(inversion, demand, rotor_n, command) ? kept : integrated;
    return command;
}

}  // namespace downwash::judge
