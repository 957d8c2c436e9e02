#pragma once

#include "downwash/dynamics/space_step.hpp"

// The test bench of thesis 3.5: a multirotor on an axle, free to pitch and nothing else. One template over the lane
// type. What drag torque and spin do about other axes the bearings carry.

namespace downwash::dynamics {

/// How the multirotor hangs.
struct PitchBench {
    LaneVector<double> axle_m;     ///< a point of the axle, which is parallel to body y, in the body frame
    LaneVector<double> place_m;    ///< the same point in the world
    double friction_nm_s_rad = 0;  ///< friction of the bearings, linear in the rate; >= 0
};

/// The state on the bench.
template <class T>
struct PitchBenchState {
    T pitch_rad, pitch_rate_rad_s;  ///< positive about +y: nose down
    T thrust_n[max_rotors];         ///< as in SpaceState
};

/// Angular acceleration [rad/s2] on the bench under the free-air thrusts of the rotors.
template <class T, class P, SpaceSurroundings<T> Around>
T pitch_acceleration(const BasicSpaceModel<P, 0>& model, const PitchBench& bench, T pitch_rad, T pitch_rate_rad_s,
                     const T thrust_n[max_rotors], const Around& around) {
    const T zero(0);
    const LaneRotation<T> attitude = rotation_about(LaneVector<T>{zero, T(1), zero}, pitch_rad);
    const LaneVector<T> from_axle = T(-1) * spread<T>(bench.axle_m);  // to the centre of mass, body axes
    const LaneVector<T> hanging = attitude * from_axle;
    const SpaceWrench<T> wrench = rotor_wrench(model, attitude, spread<T>(bench.place_m) + hanging, thrust_n, around);
    const T mass(model.multirotor_mass_kg);
    const T inertia = T(model.inertia_kg_m2.yy) + mass * (from_axle.x * from_axle.x + from_axle.z * from_axle.z);
    const T torque = wrench.torque_nm.y + (from_axle.z * wrench.force_n.x - from_axle.x * wrench.force_n.z) +
                     mass * T(standard_gravity_m_s2) * hanging.x - T(bench.friction_nm_s_rad) * pitch_rate_rad_s;
    return torque / inertia;
}

/// The state after `dt_s` with the command held: one classical Runge-Kutta step, as space_step().
/// @param thrust_command_n free-air thrust of each rotor   @param dt_s > 0
template <class T, class P, SpaceSurroundings<T> Around>
PitchBenchState<T> pitch_bench_step(const BasicSpaceModel<P, 0>& model, const PitchBench& bench,
                                    const PitchBenchState<T>& state, const T thrust_command_n[max_rotors], T dt_s,
                                    const Around& around) {
    constexpr int thrusts_at = 2;
    const int rotors = model.rotor_count;
    T y[thrusts_at + max_rotors] = {state.pitch_rad, state.pitch_rate_rad_s};
    std::copy_n(state.thrust_n, max_rotors, y + thrusts_at);
    if (!model.has_rotor_lag) {
        std::copy_n(thrust_command_n, rotors, y + thrusts_at);
    }
    runge_kutta_step(y, thrusts_at + (model.has_rotor_lag ? rotors : 0), dt_s, [&](const T* at, T* rate) {
        rate[0] = at[1];
        rate[1] = pitch_acceleration(model, bench, at[0], at[1], at + thrusts_at, around);
        for (int i = 0; i < rotors && model.has_rotor_lag; ++i) {
            rate[thrusts_at + i] = (thrust_command_n[i] - at[thrusts_at + i]) / T(model.rotor_time_constant_s);
        }
    });
    PitchBenchState<T> next{y[0], y[1], {}};
    std::copy_n(y + thrusts_at, max_rotors, next.thrust_n);
    return next;
}

}  // namespace downwash::dynamics
