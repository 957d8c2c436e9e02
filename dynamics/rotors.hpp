#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/plant.hpp"

// What rotors have in common in the plane and in space.

namespace downwash::dynamics {

/// The earliest rotor that is known to have the same thrust ratio K as rotor i, perhaps rotor i itself. A factor that
/// knows says so by `same_as(rotor)`.
template <class Factor>
int rotor_with_factor_of(const Factor& factor, int rotor) {
    if constexpr (requires { factor.same_as(rotor); }) {
        return factor.same_as(rotor);
    } else {
        return rotor;
    }
}

/// The thrust that rotor i really gives in free air for a nominal one. A factor that knows another thrust coefficient
/// says so by `thrust_scale(rotor)`.
template <class T, class Factor>
T free_air_thrust(const Factor& factor, int rotor, T nominal_n) {
    if constexpr (requires { factor.thrust_scale(rotor); }) {
        return factor.thrust_scale(rotor) * nominal_n;
    } else {
        return nominal_n;
    }
}

/// Rotor power [W] of free-air thrusts: P = K_P sum T_i^1.5 (docs/model.md 3; thesis (4.2)).
/// @param model of a plant in the plane or in space
template <class T, class Model>
T rotor_power(const Model& model, const T thrust_n[max_rotors]) {
    T sum(0);
    for (int i = 0; i < model.rotor_count; ++i) {
        // A lag shorter than the step lets a stage of the integrator undershoot a thrust that vanishes.
        sum = sum + lane::power_three_halves(lane::max(thrust_n[i], T(0)));
    }
    return T(model.power_coefficient_w_n1p5) * sum;
}

}  // namespace downwash::dynamics
