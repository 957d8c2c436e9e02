#pragma once

#include <variant>

#include "downwash/base/vector3.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/dynamics/space_model.hpp"

// The control laws of a vehicle in space, with their gains and what they remember. Nothing is computed here:
// space_inversion_control.hpp and px4_cascade_control.hpp have the arithmetic, one template over the lane type and the
// number of joints.

namespace downwash {

namespace dynamics {
// For headers that only hand them on; space_step.hpp defines them.
template <class T, int n>
struct SpaceState;
template <class T, int n>
struct SpaceCommand;
}  // namespace dynamics

// What a law knows of its vehicle; space_law_model.hpp defines it.
template <int n>
struct SpaceLawModel;

/// Gains from errors of a coordinate to its acceleration: v = ref'' + kd e' + kp e + ki integral e. All >= 0.
struct SpaceLoopGains {
    double kp_1_s2 = 0;         ///< [1/s2]
    double kd_1_s = 0;          ///< [1/s]
    double ki_1_s3 = 0;         ///< [1/s3]
    double integral_limit = 2;  ///< most that the integral may ask for, per coordinate [m/s2 or rad/s2]
};

/// Inverse dynamics with tilt first (docs/model.md 5.9): the model inversion of the plane, in space. What a law has to
/// have is in docs/extending/controller.md; this one has the same members with the number of joints beside T.
struct SpaceInversion {
    static constexpr const char* name = "model-inversion";

    SpaceLoopGains horizontal;                     ///< position error in x and y to acceleration
    SpaceLoopGains height;                         ///< the same in z, where thrust acts without a detour
    SpaceLoopGains joint = {.integral_limit = 5};  ///< joint angles to their accelerations, the same for all
    double attitude_kp_1_s = 0;                    ///< tilt error to body rate, >= 0
    double yaw_kp_1_s = 0;                         ///< yaw error to body rate, >= 0
    double rate_kp_1_s = 0;                        ///< roll and pitch rate error to angular acceleration, >= 0
    double rate_ki_1_s2 = 0;                       ///< its integral, >= 0
    double yaw_rate_kp_1_s = 0;                    ///< yaw rate error to angular acceleration, >= 0
    double yaw_rate_ki_1_s2 = 0;                   ///< its integral, >= 0
    double rate_integral_limit_rad_s2 = 5;         ///< most that an integral of the rates may ask for, > 0
    double direction_rate_filter_s = 0.1;          ///< time constant of the derivative of the wanted direction, >= 0
    bool rate_feed_forward = false;                ///< adds the derivative of the rate demand
    double max_rate_rad_s = 6;                     ///< of the demanded roll and pitch rate together, > 0
    double max_yaw_rate_rad_s = 2;                 ///< of the demanded yaw rate, > 0
    double max_tilt_rad = 0.6108652381980153;      ///< 35 degrees: of the wanted thrust, in (0, pi/2)
    double rotor_lead = 1;                         ///< docs/model.md 5.2, >= 0
    double observer_gain_1_s = 0;                  ///< L of the disturbance observer; 0: none
    double min_vertical_force_ratio = 0.2;         ///< least vertical part of the force, of the weight, in (0, 1)
    bool feed_forward = false;                     ///< divides commands by the thrust ratios of a map
    Vector3 feed_forward_offset_m = Vector3{{0, 0, 0}};  ///< of the map's surfaces from their nominal places

    /// What the law remembers between ticks.
    template <class T, int n>
    struct Memory {
        T position_integral[3];         ///< integral of the position error [m s]
        T rate_integral[3];             ///< integral of the body rate error [rad]
        T joint_integral[room_for<n>];  ///< integral of the joints' errors [rad s]; without joints one zero
        T direction[3];                 ///< wanted direction of the thrust at the tick before, world axes
        T direction_rate[3];            ///< how fast it turned, filtered, world axes [rad/s]
        T rate_reference[3];            ///< demanded body rate at the tick before [rad/s]
        T observed[space_axes<n> + 2];  ///< see SpaceObservation; zeros without an observer
    };

    /// The memory with which a flight starts in a state of the nominal plant.
    template <class T, int n>
    [[nodiscard]] Memory<T, n> rested(const SpaceLawModel<n>& nominal, const dynamics::SpaceState<T, n>& state,
                                      double tick_s) const;

    /// A memory whose integrals stand still, as those of a vehicle that touches something.
    template <class T, int n>
    [[nodiscard]] static Memory<T, n> with_integrals_of(const Memory<T, n>& before, Memory<T, n> now) {
        for (int i = 0; i < 3; ++i) {
            now.position_integral[i] = before.position_integral[i];
            now.rate_integral[i] = before.rate_integral[i];
        }
        for (int i = 0; i < n; ++i) {
            now.joint_integral[i] = before.joint_integral[i];
        }
        return now;
    }

    /// Demanded acceleration per metre of position error along an axis, x to z [1/s2].
    [[nodiscard]] double position_stiffness_1_s2(int axis) const noexcept {
        return axis == space::z ? height.kp_1_s2 : horizontal.kp_1_s2;
    }

    /// One control step, a pure function.
    /// @param nominal what the law knows of its vehicle   @param seen state as the law knows it
    /// @param tick_s control period [s], > 0   @param map thrust ratios that a feed-forward reads: see RatioMap
    /// @param[out] given the commands, within the limits   @param[out] next not the memory itself
    /// @return the saturation: greatest demand over its limit, more than 1 when something had to be clipped. A rotor's
    /// lead does not count.
    template <class T, int n, class Map>
    T control(const SpaceLawModel<n>& nominal, const dynamics::SpaceState<T, n>& seen, const Memory<T, n>& memory,
              const BasicSpacePoint<T, n>& reference, double tick_s, const Map& map,
              dynamics::SpaceCommand<T, n>& given, Memory<T, n>& next) const;
};

/// Gains from errors of a velocity or a body rate to its acceleration: v = kp e + ki integral e - kd (measured change).
/// All >= 0.
struct SpaceRateGains {
    double kp_1_s = 0;          ///< [1/s]
    double ki_1_s2 = 0;         ///< [1/s2]
    double kd = 0;              ///< [1]
    double integral_limit = 2;  ///< most that the integral may ask for, per coordinate [m/s2 or rad/s2]
};

/// PX4's cascade (docs/model.md 5.10): position P, velocity PID, thrust direction, attitude P with the reduced attitude
/// first, rates PID, control allocation. The joints of an arm have a PID. Defaults of position, velocity and attitude
/// are PX4's; its rate gains are in shares of the greatest torque, ours in SI units for a vehicle whose rotors follow
/// in 0.02 s.
struct Px4Cascade {
    static constexpr const char* name = "px4-cascade";

    double position_p_1_s = 0.95;                     ///< MPC_XY_P
    double height_p_1_s = 1;                          ///< MPC_Z_P
    SpaceRateGains velocity = {1.8, 0.4, 0.2, 4};     ///< MPC_XY_VEL_P_ACC, _I_ACC, _D_ACC
    SpaceRateGains vertical_velocity = {4, 2, 0, 4};  ///< MPC_Z_VEL_P_ACC, _I_ACC, _D_ACC
    double max_speed_m_s = 12;                        ///< MPC_XY_VEL_MAX: of the demanded velocity, > 0
    double max_climb_m_s = 3, max_descent_m_s = 1.5;  ///< MPC_Z_VEL_MAX_UP, _DN, > 0
    double max_tilt_rad = 0.7853981633974483;         ///< MPC_TILTMAX_AIR, in (0, pi/2)
    double min_thrust_ratio = 0.2;                    ///< least thrust, of the weight, in (0, 1)
    double attitude_p_1_s = 6.5;                      ///< MC_ROLL_P, MC_PITCH_P
    double yaw_p_1_s = 2.8;                           ///< MC_YAW_P
    double yaw_weight = 0.4;                          ///< MC_YAW_WEIGHT, in (0, 1]
    double max_rate_rad_s = 3.839724354387525;        ///< MC_ROLLRATE_MAX: per axis, > 0
    double max_yaw_rate_rad_s = 3.490658503988659;    ///< MC_YAWRATE_MAX, > 0
    SpaceRateGains rate = {16, 20, 0.1, 10};          ///< roll and pitch rate to angular acceleration
    SpaceRateGains yaw_rate = {6, 3, 0, 5};           ///< yaw rate to angular acceleration
    SpaceLoopGains joint = {225, 30, 1000, 500};      ///< stiff servos: to accelerations of the arm alone
    double rotor_lead = 0;                            ///< docs/model.md 5.2, >= 0

    /// What the law remembers between ticks.
    template <class T, int n>
    struct Memory {
        T velocity_integral[3];         ///< integral of the velocity error [m]
        T rate_integral[3];             ///< integral of the body rate error [rad]
        T joint_integral[room_for<n>];  ///< integral of the joints' errors [rad s]; without joints one zero
        T previous_velocity[3];         ///< at the tick before [m/s]
        T previous_rate[3];             ///< at the tick before, body axes [rad/s]
    };

    /// The memory with which a flight starts: integrals carry what the arm weighs in free air, as after a long hover.
    template <class T, int n>
    [[nodiscard]] Memory<T, n> rested(const SpaceLawModel<n>& nominal, const dynamics::SpaceState<T, n>& state,
                                      double tick_s) const;

    /// See SpaceInversion.
    template <class T, int n>
    [[nodiscard]] static Memory<T, n> with_integrals_of(const Memory<T, n>& before, Memory<T, n> now) {
        for (int i = 0; i < 3; ++i) {
            now.velocity_integral[i] = before.velocity_integral[i];
            now.rate_integral[i] = before.rate_integral[i];
        }
        for (int i = 0; i < n; ++i) {
            now.joint_integral[i] = before.joint_integral[i];
        }
        return now;
    }

    /// See SpaceInversion.
    [[nodiscard]] double position_stiffness_1_s2(int axis) const noexcept {
        return axis == space::z ? height_p_1_s * vertical_velocity.kp_1_s : position_p_1_s * velocity.kp_1_s;
    }

    /// See SpaceInversion. @param map not read
    template <class T, int n, class Map>
    T control(const SpaceLawModel<n>& nominal, const dynamics::SpaceState<T, n>& seen, const Memory<T, n>& memory,
              const BasicSpacePoint<T, n>& reference, double tick_s, const Map& map,
              dynamics::SpaceCommand<T, n>& given, Memory<T, n>& next) const;
};

using SpaceLaw = std::variant<SpaceInversion, Px4Cascade>;

/// The controller of a robot in space.
struct SpaceController {
    double rate_hz = 100;
    double delay_s = 0;  ///< age of the state that the law sees, at most 64 ticks; linear between ticks
    SpaceLaw law;
};

}  // namespace downwash
