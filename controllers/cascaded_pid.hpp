#pragma once

#include <cmath>

#include "downwash/base/lane_math.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/controllers/actuation.hpp"
#include "downwash/controllers/aids.hpp"
#include "downwash/controllers/pid.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/controllers/rest.hpp"

namespace downwash {

/// Cascaded PID as autopilots fly it (docs/model.md 5.5; thesis 3.4.2): position to velocity to tilt to pitch rate to
/// torque, each loop for itself, and a PID of the joint that knows nothing of the vehicle. Of the plant it knows weight
/// and rotors. One template over the lane type. The defaults are those of the shipped vehicle.
struct CascadedPid {
    static constexpr const char* name = "cascaded-pid";

    double horizontal_position_kp = 0.75;  ///< position error to velocity [1/s]
    double horizontal_velocity_kp = 1.1;   ///< velocity error to acceleration [1/s]
    double horizontal_velocity_ki = 0.45;  ///< its integral [1/s2]
    double horizontal_velocity_kd = 0;     ///< its derivative, of the measured velocity [1]
    double horizontal_integral_limit_m_s2 = 2.0;

    double vertical_position_kp = 2.0;  ///< the same of the height
    double vertical_velocity_kp = 7.5;
    double vertical_velocity_ki = 2.7;
    double vertical_velocity_kd = 0;
    double vertical_integral_limit_m_s2 = 4.0;

    double pitch_angle_kp = 3.6;  ///< pitch error to pitch rate [1/s]
    double pitch_rate_kp = 4.7;   ///< pitch rate error to torque [N m s]
    double pitch_rate_ki = 5.0;   ///< its integral [N m]
    double pitch_rate_kd = 0;     ///< its derivative, of the measured rate [N m s2]
    double pitch_integral_limit_nm = 6.0;

    double joint_kp = 10.5;  ///< arm error to torque [N m]
    double joint_kd = 2.1;   ///< arm rate error to torque [N m s]
    double joint_ki = 5.3;   ///< integral of the arm error [N m/s]
    double joint_integral_limit_nm = 6.0;

    double rotor_lead = 0;  ///< see controllers::limit_rotors()

    controllers::Aids aids;  ///< observer, which uses the whole model, and feed-forward

    double max_tilt_rad = 0.6108652381980153;  ///< 35 degrees: the pitch reference is clipped to this
    double min_vertical_force_ratio = 0.2;     ///< least vertical force over the weight

    /// Gains of an axis, x or z.
    struct AxisGains {
        double position_kp, velocity_kp, velocity_ki, velocity_kd, integral_limit_m_s2;
    };
    [[nodiscard]] AxisGains axis_gains(int axis) const noexcept {
        return axis == 0 ? AxisGains{horizontal_position_kp, horizontal_velocity_kp, horizontal_velocity_ki,
                                     horizontal_velocity_kd, horizontal_integral_limit_m_s2}
                         : AxisGains{vertical_position_kp, vertical_velocity_kp, vertical_velocity_ki,
                                     vertical_velocity_kd, vertical_integral_limit_m_s2};
    }

    /// What the law remembers between ticks.
    template <class T>
    struct Memory {
        T velocity_integral[2];  ///< of the velocity error, x and z [m]
        T rate_integral;         ///< of the pitch rate error [rad]
        T joint_integral;        ///< of the arm error [rad s]
        T previous_velocity[2];  ///< measured at the previous tick [m/s]
        T previous_pitch_rate;   ///< [rad/s]
    };

    /// A memory whose integrals stand still, as those of a vehicle that touches something.
    template <class T>
    [[nodiscard]] static Memory<T> with_integrals_of(const Memory<T>& before, Memory<T> now) {
        now.velocity_integral[0] = before.velocity_integral[0];
        now.velocity_integral[1] = before.velocity_integral[1];
        now.rate_integral = before.rate_integral;
        now.joint_integral = before.joint_integral;
        return now;
    }

    /// What the law answers to an error of the position along x (axis 0) or z (1) [1/s2].
    [[nodiscard]] double position_stiffness_1_s2(int axis) const {
        return axis_gains(axis).position_kp * axis_gains(axis).velocity_kp;
    }

    /// The memory of a vehicle that has hovered like this in free air: the integrals carry the weight of its arm.
    template <class T>
    [[nodiscard]] Memory<T> rested(const PlantModel& nominal, const dynamics::PlantState<T>& state) const {
        const T still[4] = {T(0), T(0), T(0), T(0)};
        const dynamics::EquationsOfMotion<T> e = dynamics::motion_at(nominal, state.q, still).equations;
        const auto carries = [](double ki, double limit, T action) {
            return ki > 0 ? lane::clamp(action, T(-limit), T(limit)) / T(ki) : T(0);
        };
        return {{T(0), T(0)},
                carries(pitch_rate_ki, pitch_integral_limit_nm, e.bias[2]),
                carries(joint_ki, joint_integral_limit_nm, e.bias[3]),
                {state.u[0], state.u[1]},
                state.u[2]};
    }

    /// One control step: a pure function. See docs/extending/controller.md for what every law has.
    /// @param aid see controllers::Unaided
    template <class T, class Aid = controllers::Unaided>
    Memory<T> control(const PlantModel& nominal, const dynamics::PlantState<T>& seen, const dynamics::Motion<T>& motion,
                      const Memory<T>& memory, const BasicReferencePoint<T>& reference, double tick_s,
                      controllers::Actuation<T>& given, Aid&& aid = {}) const {
        const T* q = seen.q;
        const T* u = seen.u;
        const dynamics::Attitude<T>& a = motion.attitude;
        const T dt_s(tick_s);

        // Position to velocity to acceleration: the force of a point of the whole mass.
        T force[2];
        T velocity_error[2];
        for (int i = 0; i < 2; ++i) {
            const AxisGains gains = axis_gains(i);
            velocity_error[i] = reference.velocity[i] + T(gains.position_kp) * (reference.position[i] - q[i]) - u[i];
            T acceleration =
                reference.acceleration[i] + T(gains.velocity_kp) * velocity_error[i] +
                controllers::integral_action(gains.velocity_ki, gains.integral_limit_m_s2, memory.velocity_integral[i]);
            if (gains.velocity_kd > 0) {
                acceleration = acceleration - T(gains.velocity_kd / tick_s) * (u[i] - memory.previous_velocity[i]);
            }
            force[i] = T(nominal.total_mass_kg) * acceleration - aid.template force<T>(i);
        }
        force[1] = force[1] + T(nominal.weight_n);

        // Its direction is the tilt; along b3 it is the thrust.
        const T least_force_z(min_vertical_force_ratio * nominal.weight_n);
        const T wanted_pitch = lane::atan2(force[0], lane::max(force[1], least_force_z));
        const T pitch_reference = lane::clamp(wanted_pitch, T(-max_tilt_rad), T(max_tilt_rad));
        const auto is_force_clipped =
            lane::max(lane::abs(wanted_pitch - pitch_reference), least_force_z - force[1]) > T(0);
        const T thrust_n = force[0] * a.sin_pitch + force[1] * a.cos_pitch;

        // Pitch to pitch rate to torque.
        const T rate_error = T(pitch_angle_kp) * (pitch_reference - q[2]) - u[2];
        T pitch_torque_nm = T(pitch_rate_kp) * rate_error +
                            controllers::integral_action(pitch_rate_ki, pitch_integral_limit_nm, memory.rate_integral);
        if (pitch_rate_kd > 0) {
            pitch_torque_nm = pitch_torque_nm - T(pitch_rate_kd / tick_s) * (u[2] - memory.previous_pitch_rate);
        }
        const T arm_error = reference.position[2] - q[3];
        const T joint_torque_nm =
            T(joint_kp) * arm_error + T(joint_kd) * (reference.velocity[2] - u[3]) +
            controllers::integral_action(joint_ki, joint_integral_limit_nm, memory.joint_integral);

        aid.command_rotors(nominal, seen, thrust_n, pitch_torque_nm - aid.template force<T>(2), tick_s, rotor_lead,
                           given);
        controllers::command_joint(nominal, joint_torque_nm - aid.template force<T>(3), given);

        // Integrators stand still where something was clipped (anti-windup).
        const auto is_clipped = given.saturation > T(1);
        Memory<T> next;
        for (int i = 0; i < 2; ++i) {
            const AxisGains gains = axis_gains(i);
            const T integral = controllers::integrate(gains.velocity_ki, gains.integral_limit_m_s2,
                                                      memory.velocity_integral[i], velocity_error[i], dt_s);
            next.velocity_integral[i] =
                lane::select(is_clipped, memory.velocity_integral[i],
                             lane::select(is_force_clipped, memory.velocity_integral[i], integral));
            next.previous_velocity[i] = u[i];
        }
        next.rate_integral = lane::select(
            is_clipped, memory.rate_integral,
            controllers::integrate(pitch_rate_ki, pitch_integral_limit_nm, memory.rate_integral, rate_error, dt_s));
        next.joint_integral = lane::select(
            is_clipped, memory.joint_integral,
            controllers::integrate(joint_ki, joint_integral_limit_nm, memory.joint_integral, arm_error, dt_s));
        next.previous_pitch_rate = u[2];
        return next;
    }

    /// How the law asks for the same commands for ever: every loop asks the one before it for what its own integral
    /// does not give.
    [[nodiscard]] controllers::Rest<Memory> rest(const PlantModel& nominal,
                                                 const dynamics::EquationsOfMotion<double>& equations,
                                                 const controllers::RestingCommand& command) const {
        const double thrust_n = command.wrench.thrust_n;
        const double* known = command.known_force;
        const auto rate = controllers::settled_pid(command.wrench.pitch_torque_nm + known[2], pitch_rate_kp,
                                                   pitch_rate_ki, pitch_integral_limit_nm);
        const auto joint =
            controllers::settled_pid(command.joint_torque_nm + known[3], joint_kp, joint_ki, joint_integral_limit_nm);
        controllers::Rest<Memory> rest;
        rest.pitch_reference_rad = controllers::error_for(rate.error, pitch_angle_kp);
        double sine = 0;
        double cosine = 1;
        lane::sin_cos(rest.pitch_reference_rad, sine, cosine);
        const double acceleration[2] = {(sine / cosine * thrust_n + known[0]) / nominal.total_mass_kg,
                                        (thrust_n + known[1] - nominal.weight_n) / nominal.total_mass_kg};
        for (int i = 0; i < 2; ++i) {
            const AxisGains gains = axis_gains(i);
            const auto velocity = controllers::settled_pid(acceleration[i], gains.velocity_kp, gains.velocity_ki,
                                                           gains.integral_limit_m_s2);
            rest.error[i] = controllers::error_for(velocity.error, gains.position_kp);
            rest.memory.velocity_integral[i] = velocity.integral;
            rest.feeds_back.velocity_integral[i] = velocity.feeds_back;
            rest.feeds_back.previous_velocity[i] = gains.velocity_kd > 0;
        }
        rest.error[2] = joint.error;
        rest.memory.rate_integral = rate.integral;
        rest.memory.joint_integral = joint.integral;
        rest.feeds_back.rate_integral = rate.feeds_back;
        rest.feeds_back.joint_integral = joint.feeds_back;
        rest.feeds_back.previous_pitch_rate = pitch_rate_kd > 0;
        const double nothing[3] = {};
        rest.height_gain_1_s2 = vertical_position_kp * vertical_velocity_kp;
        rest.pitch_gain_1_s2 =
            pitch_angle_kp * pitch_rate_kp / dynamics::rotational_system(nominal, equations, nothing).s55;
        if (!(std::abs(rest.pitch_reference_rad) < max_tilt_rad)) {
            rest.limit = HoldLimit::tilt;
        } else if (!(thrust_n > min_vertical_force_ratio * nominal.weight_n)) {
            rest.limit = HoldLimit::vertical;
        } else if (!std::isfinite(rest.error[0] + rest.error[1] + rest.error[2])) {
            rest.limit = HoldLimit::gain;
        }
        return rest;
    }

    /// The law's keys in a robot file, below `controller`.
    template <class Rows>
    static void describe(Rows& rows) {
        using Law = CascadedPid;
        rows.optional_group("horizontal", "x of the multirotor to acceleration");
        rows.add(rows.gain("horizontal.position_kp", "position error to velocity [1/s]", &Law::horizontal_position_kp));
        rows.add(
            rows.gain("horizontal.velocity_kp", "velocity error to acceleration [1/s]", &Law::horizontal_velocity_kp));
        rows.add(
            rows.gain("horizontal.velocity_ki", "integral of the velocity error [1/s2]", &Law::horizontal_velocity_ki));
        rows.add(
            rows.gain("horizontal.velocity_kd", "against the measured acceleration [1]", &Law::horizontal_velocity_kd));
        rows.add(rows.gain("horizontal.integral_limit_m_s2", "most that the integral may ask for",
                           &Law::horizontal_integral_limit_m_s2));
        rows.optional_group("vertical", "height of the multirotor to acceleration");
        rows.add(rows.gain("vertical.position_kp", "position error to velocity [1/s]", &Law::vertical_position_kp));
        rows.add(rows.gain("vertical.velocity_kp", "velocity error to acceleration [1/s]", &Law::vertical_velocity_kp));
        rows.add(
            rows.gain("vertical.velocity_ki", "integral of the velocity error [1/s2]", &Law::vertical_velocity_ki));
        rows.add(
            rows.gain("vertical.velocity_kd", "against the measured acceleration [1]", &Law::vertical_velocity_kd));
        rows.add(rows.gain("vertical.integral_limit_m_s2", "most that the integral may ask for",
                           &Law::vertical_integral_limit_m_s2));
        rows.optional_group("pitch", "pitch of the multirotor to torque");
        rows.add(rows.gain("pitch.angle_kp", "pitch error to pitch rate [1/s]", &Law::pitch_angle_kp));
        rows.add(rows.gain("pitch.rate_kp", "pitch rate error to torque [N m s]", &Law::pitch_rate_kp));
        rows.add(rows.gain("pitch.rate_ki", "integral of the pitch rate error [N m]", &Law::pitch_rate_ki));
        rows.add(rows.gain("pitch.rate_kd", "against the measured angular acceleration [N m s2]", &Law::pitch_rate_kd));
        rows.add(
            rows.gain("pitch.integral_limit_nm", "most that the integral may ask for", &Law::pitch_integral_limit_nm));
        rows.optional_group("joint", "arm angle to joint torque");
        rows.add(rows.gain("joint.kp", "[N m]", &Law::joint_kp));
        rows.add(rows.gain("joint.kd", "[N m s]", &Law::joint_kd));
        rows.add(rows.gain("joint.ki", "[N m/s]", &Law::joint_ki));
        rows.add(
            rows.gain("joint.integral_limit_nm", "most that the integral may ask for", &Law::joint_integral_limit_nm));
        rows.add_limits();
        rows.add_aids();
    }
};

}  // namespace downwash
