#pragma once

#include <cmath>
#include <optional>

#include "downwash/base/lane_math.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/controllers/actuation.hpp"
#include "downwash/controllers/aids.hpp"
#include "downwash/controllers/pid.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/controllers/rest.hpp"

namespace downwash {

/// Model-inversion PID of the multirotor and the arm (docs/model.md 5.1, 5.2; thesis figure C.2): its gains and its
/// law, one template over the lane type. Acceleration of an axis: v = acc_ref + kd e' + kp e + ki integral e.
struct ModelInversion {
    static constexpr const char* name = "model-inversion";

    double position_kp = 0;                     ///< [1/s2]
    double position_kd = 0;                     ///< [1/s]
    double position_ki = 0;                     ///< [1/s3]
    double position_integral_limit_m_s2 = 2.0;  ///< greatest ki * integral, per axis

    /// Of the height, which thrust alone controls, without the detour through the pitch. Empty: those of the position.
    std::optional<double> height_kp, height_kd, height_ki;

    double attitude_kp = 0;       ///< pitch angle to pitch rate [1/s]
    double attitude_rate_kp = 0;  ///< pitch rate to pitch acceleration [1/s]
    double attitude_rate_ki = 0;  ///< integral of the pitch rate error [1/s2]
    double attitude_integral_limit_rad_s2 = 5.0;
    double pitch_rate_filter_s = 0.1;  ///< time constant of the filtered derivative of the pitch reference
    bool rate_feed_forward = false;    ///< adds d(u5_ref)/dt to the pitch acceleration

    double arm_kp = 0;  ///< [1/s2]
    double arm_kd = 0;  ///< [1/s]
    double arm_ki = 0;  ///< [1/s3]
    double arm_integral_limit_rad_s2 = 5.0;

    double rotor_lead = 0;  ///< see controllers::limit_rotors()

    controllers::Aids aids;  ///< observer and feed-forward

    double max_tilt_rad = 0.6108652381980153;  ///< 35 degrees: the pitch reference is clipped to this
    double min_vertical_force_ratio = 0.2;     ///< f_min of the inversion as a share of the weight

    /// Gains of an axis, x or z.
    struct AxisGains {
        double kp, kd, ki;
    };
    [[nodiscard]] AxisGains axis_gains(int axis) const noexcept {
        return axis == 0 ? AxisGains{position_kp, position_kd, position_ki}
                         : AxisGains{height_kp.value_or(position_kp), height_kd.value_or(position_kd),
                                     height_ki.value_or(position_ki)};
    }

    /// What the law remembers between ticks.
    template <class T>
    struct Memory {
        T position_integral[2];  ///< of the position error, x and z [m s]
        T pitch_rate_integral;   ///< of the pitch rate error [rad]
        T arm_integral;          ///< of the arm error [rad s]
        T pitch_reference_rad;   ///< of the previous tick
        T pitch_reference_rate;  ///< filtered derivative [rad/s]
        T rate_reference;        ///< u5_ref of the previous tick [rad/s]
    };

    /// A memory whose integrals stand still, as those of a vehicle that touches something.
    template <class T>
    [[nodiscard]] static Memory<T> with_integrals_of(const Memory<T>& before, Memory<T> now) {
        now.position_integral[0] = before.position_integral[0];
        now.position_integral[1] = before.position_integral[1];
        now.pitch_rate_integral = before.pitch_rate_integral;
        now.arm_integral = before.arm_integral;
        return now;
    }

    /// What the law answers to an error of the position along x (axis 0) or z (1) [1/s2].
    [[nodiscard]] double position_stiffness_1_s2(int axis) const { return axis_gains(axis).kp; }

    /// What comes of one control step before any limit.
    template <class T>
    struct Step {
        controllers::Demand<T> demand;
        Memory<T> integrated;  ///< next memory when the demand can be met; a clipped tilt stops x and z already
        Memory<T> frozen;      ///< next memory when it was clipped: integrators stand still (anti-windup)
    };

    /// The memory at a pitch angle with nothing to correct.
    template <class T>
    [[nodiscard]] static Memory<T> rested(T pitch_rad) {
        return {{T(0), T(0)}, T(0), T(0), pitch_rad, T(0), T(0)};
    }

    /// The memory with which a flight starts in a state of the nominal plant.
    template <class T>
    [[nodiscard]] Memory<T> rested(const PlantModel& /*nominal*/, const dynamics::PlantState<T>& state) const {
        return rested(state.q[2]);
    }

    /// One control step: a pure function. See docs/extending/controller.md for what every law has.
    /// @param nominal plant as the law knows it   @param seen state as the law knows it
    /// @param motion nominal motion of that state   @param tick_s control period [s], > 0
    /// @param[out] given the commands   @param aid see controllers::Unaided   @return the memory at the end of the tick
    template <class T, class Aid = controllers::Unaided>
    Memory<T> control(const PlantModel& nominal, const dynamics::PlantState<T>& seen, const dynamics::Motion<T>& motion,
                      const Memory<T>& memory, const BasicReferencePoint<T>& reference, double tick_s,
                      controllers::Actuation<T>& given, Aid&& aid = {}) const {
        const dynamics::Motion<T>& explained = aid.explained(motion);
        const Step<T> step = demanded(nominal, seen, explained, memory, reference, T(tick_s));
        controllers::actuate(nominal, seen, explained, step.demand, tick_s, given, rotor_lead, aid);
        return select_each(given.saturation > T(1), step.frozen, step.integrated);
    }

    /// What the law demands, and both memories that may follow.
    template <class T>
    [[nodiscard]] Step<T> demanded(const PlantModel& nominal, const dynamics::PlantState<T>& seen,
                                   const dynamics::Motion<T>& motion, const Memory<T>& memory,
                                   const BasicReferencePoint<T>& reference, T dt_s) const {
        const T* q = seen.q;
        const T* u = seen.u;
        const dynamics::Attitude<T>& a = motion.attitude;
        const dynamics::EquationsOfMotion<T>& e = motion.equations;
        Step<T> step;
        step.frozen = memory;

        // Position and arm PID: the accelerations to impose.
        T v[2];
        T error[2];
        for (int i = 0; i < 2; ++i) {
            error[i] = reference.position[i] - q[i];
            const AxisGains gains = axis_gains(i);
            v[i] = reference.acceleration[i] + T(gains.kd) * (reference.velocity[i] - u[i]) + T(gains.kp) * error[i] +
                   controllers::integral_action(gains.ki, position_integral_limit_m_s2, memory.position_integral[i]);
        }
        const T arm_error = reference.position[2] - q[3];
        const T v7 = reference.acceleration[2] + T(arm_kd) * (reference.velocity[2] - u[3]) + T(arm_kp) * arm_error +
                     controllers::integral_action(arm_ki, arm_integral_limit_rad_s2, memory.arm_integral);

        // D13^-1: the force that gives these accelerations, its direction as pitch reference.
        const T mass(nominal.total_mass_kg);
        const T arm_mass(nominal.arm_mass_kg);
        const T force_x = mass * v[0] + arm_mass * e.arm_x * v7 + e.bias[0];
        const T force_z = mass * v[1] + arm_mass * e.arm_z * v7 + e.bias[1];
        const T least_force_z(min_vertical_force_ratio * nominal.total_mass_kg * standard_gravity_m_s2);
        const T wanted_pitch = lane::atan2(force_x, lane::max(force_z, least_force_z));
        const T pitch_reference = lane::clamp(wanted_pitch, T(-max_tilt_rad), T(max_tilt_rad));
        const auto is_force_clipped =
            lane::max(lane::abs(wanted_pitch - pitch_reference), least_force_z - force_z) > T(0);
        step.demand.thrust_n = force_x * a.sin_pitch + force_z * a.cos_pitch;

        // K5^-1: pitch rate reference, from a filtered backward difference of the pitch reference.
        const T raw_rate = (pitch_reference - memory.pitch_reference_rad) / dt_s;
        const T blend = dt_s / (T(pitch_rate_filter_s) + dt_s);
        step.frozen.pitch_reference_rad = pitch_reference;
        step.frozen.pitch_reference_rate =
            memory.pitch_reference_rate + blend * (raw_rate - memory.pitch_reference_rate);
        const T rate_reference = step.frozen.pitch_reference_rate + T(attitude_kp) * (pitch_reference - q[2]);
        step.frozen.rate_reference = rate_reference;

        // D5^-1: the pitch torque for the pitch acceleration, with the accelerations that this thrust will really give.
        const T rate_error = rate_reference - u[2];
        T v5 =
            T(attitude_rate_kp) * rate_error +
            controllers::integral_action(attitude_rate_ki, attitude_integral_limit_rad_s2, memory.pitch_rate_integral);
        if (rate_feed_forward) {
            v5 = v5 + (rate_reference - memory.rate_reference) / dt_s;
        }
        const T thrust = step.demand.thrust_n;
        const T inverse_mass(nominal.inverse_mass_1_kg);
        const T acceleration[4] = {
            (thrust * a.sin_pitch - e.bias[0] - arm_mass * (e.pitch_x * v5 + e.arm_x * v7)) * inverse_mass,
            (thrust * a.cos_pitch - e.bias[1] - arm_mass * (e.pitch_z * v5 + e.arm_z * v7)) * inverse_mass, v5, v7};
        T force[4];
        dynamics::inverse_dynamics(nominal, e, acceleration, force);
        step.demand.pitch_torque_nm = force[2];
        step.demand.arm_acceleration = v7;

        step.integrated = step.frozen;
        for (int i = 0; i < 2; ++i) {
            const T integral = controllers::integrate(axis_gains(i).ki, position_integral_limit_m_s2,
                                                      memory.position_integral[i], error[i], dt_s);
            step.integrated.position_integral[i] =
                lane::select(is_force_clipped, memory.position_integral[i], integral);
        }
        step.integrated.pitch_rate_integral = controllers::integrate(attitude_rate_ki, attitude_integral_limit_rad_s2,
                                                                     memory.pitch_rate_integral, rate_error, dt_s);
        step.integrated.arm_integral =
            controllers::integrate(arm_ki, arm_integral_limit_rad_s2, memory.arm_integral, arm_error, dt_s);
        return step;
    }

    /// How the law asks for the same commands for ever, worked out from the last block of figure C.2 to the first. It
    /// knows nothing of surfaces, and asks for accelerations that never come.
    /// @param balance equations of the level vehicle at rest
    [[nodiscard]] controllers::Rest<Memory> rest(const PlantModel& nominal,
                                                 const dynamics::EquationsOfMotion<double>& balance,
                                                 const controllers::RestingCommand& command) const {
        dynamics::EquationsOfMotion<double> equations = balance;
        for (int i = 0; i < 4; ++i) {
            equations.bias[i] -= command.known_force[i];
        }
        const double thrust_n = command.wrench.thrust_n;
        const double force[3] = {0, thrust_n, command.wrench.pitch_torque_nm};
        const double torque_at_rest_nm = dynamics::joint_torque_for(nominal, equations, force, 0.0);
        const double torque_per_v7 = dynamics::joint_torque_for(nominal, equations, force, 1.0) - torque_at_rest_nm;
        const double v7 = (command.joint_torque_nm - torque_at_rest_nm) / torque_per_v7;
        const dynamics::RotationalSystem<double> s = dynamics::rotational_system(nominal, equations, force);
        const double v5 = (s.g5 - s.s57 * v7) / s.s55;
        const auto rate =
            controllers::settled_pid(v5, attitude_rate_kp, attitude_rate_ki, attitude_integral_limit_rad_s2);
        controllers::Rest<Memory> rest;
        rest.pitch_reference_rad = controllers::error_for(rate.error, attitude_kp);
        double sine = 0;
        double cosine = 1;
        lane::sin_cos(rest.pitch_reference_rad, sine, cosine);
        const double mass_kg = nominal.total_mass_kg;
        const double vx = (sine / cosine * thrust_n - nominal.arm_mass_kg * equations.arm_x * v7) / mass_kg;
        const double vz = (thrust_n - equations.bias[1] - nominal.arm_mass_kg * equations.arm_z * v7) / mass_kg;
        const auto x = controllers::settled_pid(vx, position_kp, position_ki, position_integral_limit_m_s2);
        const AxisGains height = axis_gains(1);
        const auto z = controllers::settled_pid(vz, height.kp, height.ki, position_integral_limit_m_s2);
        const auto arm = controllers::settled_pid(v7, arm_kp, arm_ki, arm_integral_limit_rad_s2);
        rest.error[0] = x.error;
        rest.error[1] = z.error;
        rest.error[2] = arm.error;
        rest.memory = {{x.integral, z.integral}, rate.integral, arm.integral, rest.pitch_reference_rad, 0, rate.error};
        rest.feeds_back = {
            {x.feeds_back, z.feeds_back}, rate.feeds_back, arm.feeds_back, true, true, rate_feed_forward};
        rest.height_gain_1_s2 = height.kp;
        rest.pitch_gain_1_s2 = attitude_kp * attitude_rate_kp;
        if (!(std::abs(rest.pitch_reference_rad) < max_tilt_rad)) {
            rest.limit = HoldLimit::tilt;
        } else if (!(thrust_n > min_vertical_force_ratio * nominal.weight_n)) {
            rest.limit = HoldLimit::vertical;
        } else if (!std::isfinite(x.error + z.error + arm.error)) {
            rest.limit = HoldLimit::gain;
        }
        return rest;
    }

    /// The law's keys in a robot file, below `controller`.
    template <class Rows>
    static void describe(Rows& rows) {
        using Law = ModelInversion;
        rows.group("position", "position of the multirotor to acceleration");
        rows.add(rows.gain("position.kp", "[1/s2]", &Law::position_kp).is_required());
        rows.add(rows.gain("position.kd", "[1/s]", &Law::position_kd).is_required());
        rows.add(rows.gain("position.ki", "[1/s3]", &Law::position_ki));
        rows.add(rows.gain("position.integral_limit_m_s2", "most that the integral may ask for, per axis",
                           &Law::position_integral_limit_m_s2));
        rows.optional_group("height", "height of the multirotor to acceleration, where its gains differ");
        rows.add(rows.gain("height.kp", "[1/s2]; null: position.kp", &Law::height_kp));
        rows.add(rows.gain("height.kd", "[1/s]; null: position.kd", &Law::height_kd));
        rows.add(rows.gain("height.ki", "[1/s3]; null: position.ki", &Law::height_ki));
        rows.group("attitude", "pitch of the multirotor to angular acceleration");
        rows.add(rows.gain("attitude.kp", "pitch error to pitch rate [1/s]", &Law::attitude_kp)
                     .formerly("k5")
                     .is_required());
        rows.add(rows.gain("attitude.rate_kp", "pitch rate error to angular acceleration [1/s]", &Law::attitude_rate_kp)
                     .formerly("ku5")
                     .is_required());
        rows.add(rows.gain("attitude.rate_ki", "integral of the pitch rate error [1/s2]", &Law::attitude_rate_ki)
                     .formerly("kiu5"));
        rows.add(rows.gain("attitude.integral_limit_rad_s2", "most that the integral may ask for",
                           &Law::attitude_integral_limit_rad_s2));
        rows.add(rows.gain("attitude.pitch_rate_filter_s", "time constant of the derivative of the pitch reference",
                           &Law::pitch_rate_filter_s)
                     .at_most(10));
        rows.add(rows.flag("attitude.rate_feed_forward", "adds the derivative of the pitch rate reference",
                           &Law::rate_feed_forward));
        rows.group("arm", "arm angle to angular acceleration");
        rows.add(rows.gain("arm.kp", "[1/s2]", &Law::arm_kp).is_required());
        rows.add(rows.gain("arm.kd", "[1/s]", &Law::arm_kd).is_required());
        rows.add(rows.gain("arm.ki", "[1/s3]", &Law::arm_ki));
        rows.add(rows.gain("arm.integral_limit_rad_s2", "most that the integral may ask for",
                           &Law::arm_integral_limit_rad_s2));
        rows.add_limits();
        rows.add_aids();
    }
};

}  // namespace downwash
