#pragma once

#include "downwash/dynamics/lane_vector.hpp"

// Roll, pitch and yaw for laws that are written in them: yaw about z first, then pitch about y, then roll about x.

namespace downwash::controllers {

/// Three angles [rad], their rates or their accelerations.
template <class T>
struct EulerAngles {
    T roll, pitch, yaw;
};

/// Roll and yaw in (-pi, pi], pitch in [-pi/2, pi/2].
template <class T>
EulerAngles<T> euler_angles(const dynamics::LaneRotation<T>& r) {
    const T level = lane::sqrt(r.second.z * r.second.z + r.third.z * r.third.z);
    return {lane::atan2(r.second.z, r.third.z), lane::atan2(-r.first.z, level), lane::atan2(r.first.y, r.first.x)};
}

/// Sines and cosines of roll and pitch.
template <class T>
struct EulerTilt {
    T sin_roll, cos_roll, sin_pitch, cos_pitch;
};

/// Sines and cosines of the roll and pitch of three angles. @pre angles at most 1e5 rad
template <class T>
EulerTilt<T> euler_tilt(const EulerAngles<T>& angles) {
    EulerTilt<T> tilt;
    lane::sin_cos(angles.roll, tilt.sin_roll, tilt.cos_roll);
    lane::sin_cos(angles.pitch, tilt.sin_pitch, tilt.cos_pitch);
    return tilt;
}

/// Rates of the angles [rad/s] at an angular velocity in body axes [rad/s]. @pre the pitch is not a quarter turn
template <class T>
EulerAngles<T> euler_rates(const EulerTilt<T>& t, const dynamics::LaneVector<T>& rate) {
    const T across = t.sin_roll * rate.y + t.cos_roll * rate.z;
    const T yaw = across / t.cos_pitch;
    return {rate.x + t.sin_pitch * yaw, t.cos_roll * rate.y - t.sin_roll * rate.z, yaw};
}

/// The angular acceleration in body axes [rad/s2] with which the angles accelerate as given [rad/s2].
template <class T>
dynamics::LaneVector<T> body_acceleration(const EulerTilt<T>& t, const EulerAngles<T>& rates,
                                          const EulerAngles<T>& accelerations) {
    // The derivative of (roll' - s_p yaw', c_r pitch' + s_r c_p yaw', -s_r pitch' + c_r c_p yaw').
    const T pitch_turn = accelerations.pitch + t.cos_pitch * (rates.roll * rates.yaw);
    const T yaw_turn =
        t.cos_pitch * accelerations.yaw - rates.roll * rates.pitch - t.sin_pitch * (rates.pitch * rates.yaw);
    return {accelerations.roll - t.sin_pitch * accelerations.yaw - t.cos_pitch * (rates.pitch * rates.yaw),
            t.cos_roll * pitch_turn + t.sin_roll * yaw_turn, t.cos_roll * yaw_turn - t.sin_roll * pitch_turn};
}

}  // namespace downwash::controllers
