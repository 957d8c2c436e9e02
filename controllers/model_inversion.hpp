#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/gains.hpp"
#include "downwash/dynamics/flight_step.hpp"

// Model-inversion PID of the multirotor and the arm (docs/model.md 5.1, 5.2; thesis figure C.2), one template over the
// lane type. A control step is a pure function: what the controller remembers is a plain value beside the plant's
// state.

namespace downwash::controllers {

/// What the controller should follow, per axis (x, z, arm).
template <class T>
struct Setpoint {
    T position[3], velocity[3], acceleration[3];
};

/// What the controller remembers between ticks.
template <class T>
struct ControllerState {
    T position_integral[2];  ///< of the position error, x and z [m s]
    T pitch_rate_integral;   ///< of the pitch rate error [rad]
    T arm_integral;          ///< of the arm error [rad s]
    T pitch_reference_rad;   ///< of the previous tick
    T pitch_reference_rate;  ///< filtered derivative [rad/s]
    T rate_reference;        ///< u5_ref of the previous tick [rad/s]
};

/// The memory of a controller that starts at a pitch angle with nothing to correct.
template <class T>
ControllerState<T> rested_controller(T pitch_rad) {
    return {{T(0), T(0)}, T(0), T(0), pitch_rad, T(0), T(0)};
}

/// What the controller asks for, before allocation and any limit.
template <class T>
struct Demand {
    T thrust_n;          ///< F3
    T pitch_torque_nm;   ///< T2
    T arm_acceleration;  ///< v7 [rad/s2]; the joint torque follows from it and from what the rotors really give
};

/// Demand and next memory of one control step.
template <class T>
struct ControlStep {
    Demand<T> demand;
    ControllerState<T> integrated;  ///< next memory when the demand can be met; a clipped tilt stops x and z already
    ControllerState<T> frozen;      ///< next memory when it was clipped: integrators stand still (anti-windup)
};

/// D7^-1: the joint torque for the demanded arm acceleration under the thrust and pitch torque that the rotors give.
/// Where they give what was demanded this is row 4 with the accelerations of the inversion (docs/model.md 5.2). Where
/// they lag or are clipped it is not: a joint that pushes against a pitch acceleration that has yet to come would tip
/// the vehicle the wrong way, and hover with a hanging arm would diverge from a lag of 10 ms on.
template <class T>
T joint_torque(const PlantModel& model, const dynamics::Motion<T>& motion, T arm_acceleration, T thrust_n,
               T pitch_torque_nm) {
    const T force[3] = {thrust_n * motion.attitude.sin_pitch, thrust_n * motion.attitude.cos_pitch, pitch_torque_nm};
    return dynamics::joint_torque_for(model, motion.equations, force, arm_acceleration);
}

/// ki * integral, within its limit.
template <class T>
T integral_action(double ki, double limit, T integral) {
    return lane::clamp(T(ki) * integral, T(-limit), T(limit));
}

/// Adds error * dt; an integral never grows beyond what its limit can use.
template <class T>
T integrate(double ki, double limit, T integral, T error, T dt_s) {
    if (!(ki > 0)) {
        return integral;
    }
    const T most(limit / ki);
    return lane::clamp(integral + error * dt_s, -most, most);
}

/// One control step.
/// @param q,u plant coordinates and speeds   @param motion theirs   @param tick_s control period [s], > 0
template <class T>
ControlStep<T> model_inversion_control(const PlantModel& model, const ControllerGains& gains, const T q[4],
                                       const T u[4], const dynamics::Motion<T>& motion,
                                       const ControllerState<T>& memory, const Setpoint<T>& reference, T tick_s) {
    const dynamics::Attitude<T>& a = motion.attitude;
    const dynamics::EquationsOfMotion<T>& e = motion.equations;
    ControlStep<T> step;
    step.frozen = memory;

    // Position and arm PID: the accelerations to impose.
    T v[2];
    T error[2];
    for (int i = 0; i < 2; ++i) {
        error[i] = reference.position[i] - q[i];
        v[i] = reference.acceleration[i] + T(gains.position_kd) * (reference.velocity[i] - u[i]) +
               T(gains.position_kp) * error[i] +
               integral_action(gains.position_ki, gains.position_integral_limit_m_s2, memory.position_integral[i]);
    }
    const T arm_error = reference.position[2] - q[3];
    const T v7 = reference.acceleration[2] + T(gains.arm_kd) * (reference.velocity[2] - u[3]) +
                 T(gains.arm_kp) * arm_error +
                 integral_action(gains.arm_ki, gains.arm_integral_limit_rad_s2, memory.arm_integral);

    // D13^-1: the force that gives these accelerations, its direction as pitch reference.
    const T mass(model.total_mass_kg);
    const T arm_mass(model.arm_mass_kg);
    const T force_x = mass * v[0] + arm_mass * e.arm_x * v7 + e.bias[0];
    const T force_z = mass * v[1] + arm_mass * e.arm_z * v7 + e.bias[1];
    const T least_force_z(gains.min_vertical_force_ratio * model.total_mass_kg * standard_gravity_m_s2);
    const T wanted_pitch = lane::atan2(force_x, lane::max(force_z, least_force_z));
    const T pitch_reference = lane::clamp(wanted_pitch, T(-gains.max_tilt_rad), T(gains.max_tilt_rad));
    const auto is_force_clipped = lane::max(lane::abs(wanted_pitch - pitch_reference), least_force_z - force_z) > T(0);
    step.demand.thrust_n = force_x * a.sin_pitch + force_z * a.cos_pitch;

    // K5^-1: pitch rate reference, from a filtered backward difference of the pitch reference.
    const T raw_rate = (pitch_reference - memory.pitch_reference_rad) / tick_s;
    const T blend = tick_s / (T(gains.pitch_rate_filter_s) + tick_s);
    step.frozen.pitch_reference_rad = pitch_reference;
    step.frozen.pitch_reference_rate = memory.pitch_reference_rate + blend * (raw_rate - memory.pitch_reference_rate);
    const T rate_reference = step.frozen.pitch_reference_rate + T(gains.attitude_k5) * (pitch_reference - q[2]);
    step.frozen.rate_reference = rate_reference;

    // D5^-1: the pitch torque for the pitch acceleration, with the accelerations that this thrust will really give.
    const T rate_error = rate_reference - u[2];
    T v5 = T(gains.attitude_ku5) * rate_error +
           integral_action(gains.attitude_kiu5, gains.attitude_integral_limit_rad_s2, memory.pitch_rate_integral);
    if (gains.rate_feed_forward) {
        v5 = v5 + (rate_reference - memory.rate_reference) / tick_s;
    }
    const T thrust = step.demand.thrust_n;
    const T inverse_mass(model.inverse_mass_1_kg);
    const T acceleration[4] = {
        (thrust * a.sin_pitch - e.bias[0] - arm_mass * (e.pitch_x * v5 + e.arm_x * v7)) * inverse_mass,
        (thrust * a.cos_pitch - e.bias[1] - arm_mass * (e.pitch_z * v5 + e.arm_z * v7)) * inverse_mass, v5, v7};
    T force[4];
    dynamics::inverse_dynamics(model, e, acceleration, force);
    step.demand.pitch_torque_nm = force[2];
    step.demand.arm_acceleration = v7;

    step.integrated = step.frozen;
    for (int i = 0; i < 2; ++i) {
        const T integral = integrate(gains.position_ki, gains.position_integral_limit_m_s2, memory.position_integral[i],
                                     error[i], tick_s);
        step.integrated.position_integral[i] = lane::select(is_force_clipped, memory.position_integral[i], integral);
    }
    step.integrated.pitch_rate_integral = integrate(gains.attitude_kiu5, gains.attitude_integral_limit_rad_s2,
                                                    memory.pitch_rate_integral, rate_error, tick_s);
    step.integrated.arm_integral =
        integrate(gains.arm_ki, gains.arm_integral_limit_rad_s2, memory.arm_integral, arm_error, tick_s);
    return step;
}

/// The same where the motion at q and u is not known yet.
template <class T>
ControlStep<T> model_inversion_control(const PlantModel& model, const ControllerGains& gains, const T q[4],
                                       const T u[4], const ControllerState<T>& memory, const Setpoint<T>& reference,
                                       T tick_s) {
    return model_inversion_control(model, gains, q, u, dynamics::motion_at(model, q, u), memory, reference, tick_s);
}

}  // namespace downwash::controllers
