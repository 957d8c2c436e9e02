#pragma once

#include <optional>

#include "downwash/controllers/actuation.hpp"
#include "downwash/controllers/aids.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/controllers/rest.hpp"
#include "downwash/dynamics/plant_model.hpp"

namespace downwash {

/// Model-inversion PID of the multirotor and the arm (docs/model.md 5.1, 5.2; thesis figure C.2): its gains, its memory
/// and its keys. The law itself is in model_inversion_control.hpp, one template over the lane type. Acceleration of an
/// axis: v = acc_ref + kd e' + kp e + ki integral e.
struct ModelInversion {
    static constexpr const char* name = "model-inversion";

    double position_kp = 0;                     ///< [1/s2]
    double position_kd = 0;                     ///< [1/s]
    double position_ki = 0;                     ///< [1/s3]
    double position_integral_limit_m_s2 = 2.0;  ///< greatest ki * integral, per axis

    /// Gains of the height, which thrust alone controls, without the detour through the pitch. Empty: those of the
    /// position.
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
        T position_integral[2];  ///< integral of the position error, x and z [m s]
        T pitch_rate_integral;   ///< integral of the pitch rate error [rad]
        T arm_integral;          ///< integral of the arm error [rad s]
        T pitch_reference_rad;   ///< pitch reference of the previous tick
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

    /// Demanded acceleration per metre of position error, along x (axis 0) or z (1) [1/s2].
    [[nodiscard]] double position_stiffness_1_s2(int axis) const { return axis_gains(axis).kp; }

    /// The result of one control step before any limit.
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
                      controllers::Actuation<T>& given, Aid&& aid = {}) const;

    /// What the law demands, and both memories that may follow.
    template <class T>
    [[nodiscard]] Step<T> demanded(const PlantModel& nominal, const dynamics::PlantState<T>& seen,
                                   const dynamics::Motion<T>& motion, const Memory<T>& memory,
                                   const BasicReferencePoint<T>& reference, T dt_s) const;

    /// The equilibrium of the law, worked out from the last block of figure C.2 to the first. The law does not know the
    /// surfaces, so it asks for accelerations that never come.
    /// @param balance equations of the level vehicle at rest
    [[nodiscard]] controllers::Rest<Memory> rest(const PlantModel& nominal,
                                                 const dynamics::EquationsOfMotion<double>& balance,
                                                 const controllers::RestingCommand& command) const;

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
