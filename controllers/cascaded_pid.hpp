#pragma once

#include "downwash/controllers/actuation.hpp"
#include "downwash/controllers/aids.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/controllers/rest.hpp"
#include "downwash/dynamics/plant_model.hpp"

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

    double vertical_position_kp = 2.0;  ///< height error to velocity [1/s]
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
        T velocity_integral[2];  ///< integral of the velocity error, x and z [m]
        T rate_integral;         ///< integral of the pitch rate error [rad]
        T joint_integral;        ///< integral of the arm error [rad s]
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

    /// Demanded acceleration per metre of position error, along x (axis 0) or z (1) [1/s2].
    [[nodiscard]] double position_stiffness_1_s2(int axis) const {
        return axis_gains(axis).position_kp * axis_gains(axis).velocity_kp;
    }

    /// The memory of a vehicle that has hovered like this in free air: the integrals carry the weight of its arm.
    template <class T>
    [[nodiscard]] Memory<T> rested(const PlantModel& nominal, const dynamics::PlantState<T>& state) const;

    /// One control step: a pure function. See docs/extending/controller.md for what every law has.
    /// @param aid see controllers::Unaided
    template <class T, class Aid = controllers::Unaided>
    Memory<T> control(const PlantModel& nominal, const dynamics::PlantState<T>& seen, const dynamics::Motion<T>& motion,
                      const Memory<T>& memory, const BasicReferencePoint<T>& reference, double tick_s,
                      controllers::Actuation<T>& given, Aid&& aid = {}) const;

    /// The equilibrium of the law: every loop asks the one before it for what its own integral does not give.
    [[nodiscard]] controllers::Rest<Memory> rest(const PlantModel& nominal,
                                                 const dynamics::EquationsOfMotion<double>& equations,
                                                 const controllers::RestingCommand& command) const;

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
