#pragma once

#include "downwash/controllers/euler_angles.hpp"
#include "downwash/controllers/lyapunov_coordinate.hpp"
#include "downwash/dynamics/space_allocation.hpp"
#include "downwash/dynamics/space_step.hpp"

// The Lyapunov laws of thesis 4.6 for a multirotor in space without an arm, mended (docs/model.md 5.8). One template
// over the lane type; pure functions without memory.

namespace downwash::controllers {

/// Gains of all laws. The defaults suit a quadrotor of some kilograms.
struct LyapunovLaw {
    LyapunovGains roll{8, 8}, pitch{8, 8}, yaw{1, 1};
    LyapunovGains x{1, 1}, y{1, 1}, z{2, 2};
    double max_tilt_rad = 0.35;     ///< largest roll and pitch that the position law asks for, in (0, pi/2)
    double min_thrust_ratio = 0.1;  ///< least acting thrust that all laws together ask for, of the weight; > 0
};

/// The references of roll, pitch and yaw.
template <class T>
struct AttitudeTarget {
    LyapunovTarget<T> roll, pitch, yaw;
};

/// The torque about the centre of mass, in body axes [N m], of the attitude laws (thesis (4.22), (4.24), (4.25)). It
/// cancels gyroscopic terms with the sign that (4.9) gives them, and knows that rates of angles are not body rates.
/// @param rate in body axes [rad/s]   @param rotor_spin dynamics::rotor_spin_of() the thrusts at this moment
template <class T, class P>
dynamics::LaneVector<T> attitude_torque(const BasicSpaceModel<P, 0>& model, const LyapunovLaw& law,
                                        const EulerAngles<T>& angles, const dynamics::LaneVector<T>& rate,
                                        const dynamics::LaneVector<T>& rotor_spin, const AttitudeTarget<T>& target) {
    const EulerTilt<T> tilt = euler_tilt(angles);
    const EulerAngles<T> rates = euler_rates(tilt, rate);
    const auto demanded = [](const LyapunovGains& gains, const T& angle, const T& angle_rate,
                             const LyapunovTarget<T>& to) {
        const T error = lane::wrap_angle(angle - to.value);
        return lyapunov_acceleration(gains, lyapunov_errors(gains, error, angle_rate, to), to);
    };
    const EulerAngles<T> accelerations{demanded(law.roll, angles.roll, rates.roll, target.roll),
                                       demanded(law.pitch, angles.pitch, rates.pitch, target.pitch),
                                       demanded(law.yaw, angles.yaw, rates.yaw, target.yaw)};
    const dynamics::LaneSymmetric<T> inertia = dynamics::spread<T>(model.inertia_kg_m2);
    return inertia * body_acceleration(tilt, rates, accelerations) + cross(rate, inertia * rate + rotor_spin);
}

/// The total thrust [N] of the altitude law (thesis (4.30)): what must act, K included.
/// @param third_z how much of b3 points up: cos roll cos pitch, > 0
template <class T, class P>
T altitude_thrust(const BasicSpaceModel<P, 0>& model, const LyapunovLaw& law, const T& z_m, const T& z_rate_m_s,
                  const T& third_z, const LyapunovTarget<T>& target) {
    const LyapunovErrors<T> errors = lyapunov_errors(law.z, z_m - target.value, z_rate_m_s, target);
    return T(model.total_mass_kg) * (T(standard_gravity_m_s2) + lyapunov_acceleration(law.z, errors, target)) / third_z;
}

/// Roll and pitch of the position law (thesis (4.33), (4.34)).
template <class T>
struct TiltDemand {
    T roll_rad, pitch_rad;
};

/// The tilt that turns the thrust towards where it is needed. The thesis divides by U_z, which is K_c times too small
/// where a ceiling helps: here it is the acting thrust.
/// @param acting_thrust_n altitude_thrust(), > 0   @param yaw_rad of the vehicle
template <class T, class P>
TiltDemand<T> position_tilt(const BasicSpaceModel<P, 0>& model, const LyapunovLaw& law,
                            const dynamics::LaneVector<T>& position_m, const dynamics::LaneVector<T>& velocity_m_s,
                            const T& acting_thrust_n, const T& yaw_rad, const LyapunovTarget<T>& x,
                            const LyapunovTarget<T>& y) {
    const T mass_per_thrust = T(model.total_mass_kg) / acting_thrust_n;
    const auto demanded = [&](const LyapunovGains& gains, const T& at, const T& rate, const LyapunovTarget<T>& to) {
        return mass_per_thrust * lyapunov_acceleration(gains, lyapunov_errors(gains, at - to.value, rate, to), to);
    };
    const T u_x = demanded(law.x, position_m.x, velocity_m_s.x, x);
    const T u_y = demanded(law.y, position_m.y, velocity_m_s.y, y);
    // u_x = c_roll s_pitch c_yaw + s_roll s_yaw and u_y = c_roll s_pitch s_yaw - s_roll c_yaw, solved for the tilt.
    T sin_yaw, cos_yaw;
    lane::sin_cos(yaw_rad, sin_yaw, cos_yaw);
    const T limit(lane::sin_cos(law.max_tilt_rad).sine);
    const T sin_roll = lane::clamp(u_x * sin_yaw - u_y * cos_yaw, -limit, limit);
    const T cos_roll = lane::sqrt(T(1) - sin_roll * sin_roll);
    const T sin_pitch = lane::clamp((u_x * cos_yaw + u_y * sin_yaw) / cos_roll, -limit, limit);
    return {lane::atan2(sin_roll, cos_roll), lane::atan2(sin_pitch, lane::sqrt(T(1) - sin_pitch * sin_pitch))};
}

/// Free-air thrusts [N] that act as demanded where the surroundings multiply thrust, roll and pitch torque by K_c
/// (thesis (4.15), (4.16)); yaw torque of level rotors comes from drag, which has no K. Not clipped.
/// @param acting_thrust_n,torque_nm along b3, and about the centre of mass in body axes
/// @param ceiling_factor K_c at the height of the vehicle, or 1: the law without it
template <class T>
void lyapunov_thrusts(const SpaceAllocation& allocation, const T& acting_thrust_n,
                      const dynamics::LaneVector<T>& torque_nm, const T& ceiling_factor, T thrust_n[max_rotors]) {
    const T demand[4] = {acting_thrust_n / ceiling_factor, torque_nm.x / ceiling_factor, torque_nm.y / ceiling_factor,
                         torque_nm.z};
    dynamics::allocate(allocation, demand, thrust_n);
}

/// Where the vehicle shall be, and its heading.
template <class T>
struct LyapunovReference {
    LyapunovTarget<T> x, y, z, yaw;
};

/// All laws one after the other: altitude, position, attitude, rotors. The attitude law takes the rates of the demanded
/// tilt as zero; the thesis says nothing about them. So V is shown to fall for each law alone, not for all together.
/// @param state its thrusts are those of the rotors at this moment   @param ceiling_factor see lyapunov_thrusts()
/// @return the tilt that the position law asked for
template <class T, class P>
TiltDemand<T> lyapunov_commands(const BasicSpaceModel<P, 0>& model, const SpaceAllocation& allocation,
                                const LyapunovLaw& law, const dynamics::SpaceState<T, 0>& state,
                                const LyapunovReference<T>& reference, const T& ceiling_factor,
                                T thrust_n[max_rotors]) {
    using dynamics::LaneVector;
    const dynamics::LaneRotation<T> attitude = dynamics::rotation_of(state.q + 3);
    const EulerAngles<T> angles = euler_angles(attitude);
    // The position law divides by this thrust: it stays positive if the vehicle has to fall faster than g or is upside
    // down.
    const T least_n = T(law.min_thrust_ratio * standard_gravity_m_s2) * T(model.total_mass_kg);
    const T acting_n =
        lane::max(least_n, altitude_thrust(model, law, state.q[2], state.u[2], attitude.third.z, reference.z));
    const TiltDemand<T> tilt = position_tilt(model, law, LaneVector<T>{state.q[0], state.q[1], state.q[2]},
                                             LaneVector<T>{state.u[0], state.u[1], state.u[2]}, acting_n, angles.yaw,
                                             reference.x, reference.y);
    const T none(0);
    const AttitudeTarget<T> target{{tilt.roll_rad, none, none}, {tilt.pitch_rad, none, none}, reference.yaw};
    const LaneVector<T> torque = attitude_torque(model, law, angles, LaneVector<T>{state.u[3], state.u[4], state.u[5]},
                                                 dynamics::rotor_spin_of(model, state.thrust_n), target);
    lyapunov_thrusts(allocation, acting_n, torque, ceiling_factor, thrust_n);
    return tilt;
}

}  // namespace downwash::controllers
