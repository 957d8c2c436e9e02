#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/plant.hpp"

namespace downwash::dynamics {

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

/// The same of rotors of which some give the same thrust as an earlier one.
/// @param as the earliest rotor that each gives the thrust of, perhaps that rotor itself
template <class T, class Model>
T rotor_power(const Model& model, const T thrust_n[max_rotors], const int as[max_rotors]) {
    T sum(0);
    T each[max_rotors] = {};
    for (int i = 0; i < model.rotor_count; ++i) {
        if (as[i] == i) {
            each[i] = lane::power_three_halves(lane::max(thrust_n[i], T(0)));
        }
        sum = sum + each[as[i]];
    }
    return T(model.power_coefficient_w_n1p5) * sum;
}

}  // namespace downwash::dynamics
