#pragma once

// The polynomial of a reference segment, one template over the lane type.

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

}  // namespace downwash::controllers
