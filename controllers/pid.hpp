#pragma once

#include <cmath>

#include "downwash/base/lane_math.hpp"

// The integral part of a PID with a limit, and where such a PID settles. One template over the lane type.

namespace downwash::controllers {

/// ki * integral, within its limit.
template <class T>
T integral_action(double ki, double limit, T integral) {
    return lane::clamp(T(ki) * integral, T(-limit), T(limit));
}

/// Adds error * dt; an integral never grows beyond what its limit can use.
template <class T>
T integrate(double ki, double limit, T integral, T error, T dt_s) {
    if (!(ki > 0)) {
        return integral;
    }
    const T most(limit / ki);
    return lane::clamp(integral + error * dt_s, -most, most);
}

/// The same, or the integral as it was where a condition holds (anti-windup).
/// @param is_frozen of the lane type that lane::select() takes for T
template <class T, class Condition>
T integral_unless(const Condition& is_frozen, double ki, double limit, T integral, T error, T dt_s) {
    return lane::select(is_frozen, integral, integrate(ki, limit, integral, error, dt_s));
}

/// The error that makes a gain give an action; infinite without a gain.
inline double error_for(double action, double gain) {
    return action == 0 ? 0 : action / gain;
}

/// What a PID settles at when it has to give an action for ever.
struct SettledPid {
    double error, integral;
    bool feeds_back;  ///< the integral answers small disturbances: it has a gain and is not at its limit
};

/// The error and the integral with which a PID gives `action` for ever.
inline SettledPid settled_pid(double action, double kp, double ki, double limit) {
    if (!(ki > 0)) {
        return {error_for(action, kp), 0, false};
    }
    if (std::abs(action) < limit) {
        return {0, action / ki, true};
    }
    const double most = action > 0 ? limit : -limit;
    return {error_for(action - most, kp), most / ki, false};
}

}  // namespace downwash::controllers
