#pragma once

// The polynomial of a reference segment, one template over the lane type: for axes in the plane and in space alike.

namespace downwash::controllers {

/// Position, velocity and acceleration of one axis.
template <class T>
struct QuinticPoint {
    T position, velocity, acceleration;
};

/// c[0] + c[1] s + ... + c[5] s^5 and its derivatives by time.
/// @param s time over the segment's duration, in [0, 1]   @param inverse_duration [1/s]
template <class T>
QuinticPoint<T> quintic_at(const T c[6], T s, T inverse_duration) {
    return {c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5])))),
            (c[1] + s * (T(2) * c[2] + s * (T(3) * c[3] + s * (T(4) * c[4] + s * (T(5) * c[5]))))) * inverse_duration,
            (T(2) * c[2] + s * (T(6) * c[3] + s * (T(12) * c[4] + s * (T(20) * c[5])))) * inverse_duration *
                inverse_duration};
}

/// The coefficients of the one quintic that meets position, velocity and acceleration at both ends (Hermite), in the
/// powers of the time over the segment's duration.
/// @param duration [s], > 0
template <class T>
void quintic_between(const QuinticPoint<T>& from, const QuinticPoint<T>& to, T duration, T c[6]) {
    const T v0 = from.velocity * duration;
    const T a0 = from.acceleration * duration * duration;
    const T v1 = to.velocity * duration;
    const T a1 = to.acceleration * duration * duration;
    const T d = to.position - from.position;
    c[0] = from.position;
    c[1] = v0;
    c[2] = T(0.5) * a0;
    c[3] = T(10) * d - T(6) * v0 - T(4) * v1 - T(1.5) * a0 + T(0.5) * a1;
    c[4] = T(-15) * d + T(8) * v0 + T(7) * v1 + T(1.5) * a0 - a1;
    c[5] = T(6) * d - T(3) * (v0 + v1) - T(0.5) * (a0 - a1);
}

}  // namespace downwash::controllers
