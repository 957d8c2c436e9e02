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
    constexpr double share_of_step[] = {0, 0.5, 0.5, 1};
    constexpr double weight[] = {1, 2, 2, 1};
    const bool has_lag = model.has_rotor_lag;
    const int rotors = model.rotor_count;
    PitchBenchState<T> at = state;
    T thrust_rate[max_rotors], thrust_sum[max_rotors];
    for (int i = 0; i < rotors; ++i) {
        at.thrust_n[i] = has_lag ? state.thrust_n[i] : thrust_command_n[i];
        thrust_sum[i] = T(0);
    }
    T acceleration(0), pitch_sum(0), rate_sum(0);
    for (int stage = 0; stage < 4; ++stage) {
        if (stage > 0) {
            const T step_s = T(share_of_step[stage]) * dt_s;
            at.pitch_rad = state.pitch_rad + step_s * at.pitch_rate_rad_s;
            at.pitch_rate_rad_s = state.pitch_rate_rad_s + step_s * acceleration;
            if (has_lag) {
                for (int i = 0; i < rotors; ++i) {
                    at.thrust_n[i] = state.thrust_n[i] + step_s * thrust_rate[i];
                }
            }
        }
        acceleration = pitch_acceleration(model, bench, at.pitch_rad, at.pitch_rate_rad_s, at.thrust_n, around);
        const T w(weight[stage]);
        pitch_sum = pitch_sum + w * at.pitch_rate_rad_s;
        rate_sum = rate_sum + w * acceleration;
        if (has_lag) {
            for (int i = 0; i < rotors; ++i) {
                thrust_rate[i] = (thrust_command_n[i] - at.thrust_n[i]) / T(model.rotor_time_constant_s);
                thrust_sum[i] = thrust_sum[i] + w * thrust_rate[i];
            }
        }
    }
    const T sixth_s = dt_s * T(1.0 / 6.0);
    PitchBenchState<T> next = state;
    next.pitch_rad = state.pitch_rad + sixth_s * pitch_sum;
    next.pitch_rate_rad_s = state.pitch_rate_rad_s + sixth_s * rate_sum;
    for (int i = 0; i < rotors; ++i) {
        next.thrust_n[i] = has_lag ? state.thrust_n[i] + sixth_s * thrust_sum[i] : thrust_command_n[i];
    }
    return next;
}

}  // namespace downwash::dynamics
