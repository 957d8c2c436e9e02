#pragma once

// The Lyapunov law of one coordinate (docs/model.md 5.8; thesis (4.17) to (4.22)). With e = x - x_d and
// e' = dx/dt - dx_d/dt + k e it makes V = (e^2 + e'^2) / 2 fall at -k e^2 - k' e'^2.

namespace downwash::controllers {

/// Gains of one coordinate, both > 0 [1/s].
struct LyapunovGains {
    double k = 1;       ///< gain of the error
    double k_rate = 1;  ///< k', gain of the speed's error
};

/// The reference of one coordinate: value, speed and acceleration.
template <class T>
struct LyapunovTarget {
    T value, rate, acceleration;
};

/// The two errors of one coordinate.
template <class T>
struct LyapunovErrors {
    T e, e_rate;
};

/// The errors of a coordinate (thesis (4.17), (4.18)). @param error x - x_d, turned into (-pi, pi] for an angle
template <class T>
LyapunovErrors<T> lyapunov_errors(const LyapunovGains& gains, const T& error, const T& rate,
                                  const LyapunovTarget<T>& target) {
    return {error, rate - target.rate + T(gains.k) * error};
}

/// The Lyapunov function V.
template <class T>
T lyapunov_function(const LyapunovErrors<T>& errors) {
    return T(0.5) * (errors.e * errors.e + errors.e_rate * errors.e_rate);
}

/// The acceleration that makes V fall: x_d'' + (k^2 - 1) e - (k + k') e'. The thesis leaves x_d'' out and writes one
/// gain for two.
template <class T>
T lyapunov_acceleration(const LyapunovGains& gains, const LyapunovErrors<T>& errors, const LyapunovTarget<T>& target) {
    return target.acceleration + T(gains.k * gains.k - 1) * errors.e - T(gains.k + gains.k_rate) * errors.e_rate;
}

}  // namespace downwash::controllers
