#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/aids.hpp"
#include "downwash/dynamics/flight_step.hpp"

// Rotor commands divided by the thrust ratios K that a controller reads from a map (docs/model.md 5.7; thesis 3.4.4).
// The map is a function here. One template over the lane type.

namespace downwash::controllers {

/// What a law has read for one tick.
template <class T>
struct ReadRatios {
    T rotor[max_rotors];  ///< K of each
    T body_push;          ///< K_body - 1; 0 without a fountain
};

/// The least K that a law takes from a map, so that commands stay finite.
inline constexpr double min_read_ratio = 0.1;

/// K at the rotors of the vehicle that a law sees.
/// @param map what the law reads
template <class T, dynamics::ThrustRatios<T> Map>
ReadRatios<T> read_ratios(const FeedForward& feed_forward, const PlantModel& nominal,
                          const dynamics::PlantState<T>& seen, const dynamics::Attitude<T>& a, const Map& map) {
    const T x_m = seen.q[0] - T(feed_forward.offset_x_m);
    const T z_m = seen.q[1] - T(feed_forward.offset_z_m);
    ReadRatios<T> ratios;
    for (int i = 0; i < nominal.rotor_count; ++i) {
        if (const int same = map.same_as(i); same != i) {
            ratios.rotor[i] = ratios.rotor[same];
        } else {
            const dynamics::PlanePoint<T> hub = dynamics::rotor_position(nominal, a, x_m, z_m, i);
            ratios.rotor[i] = lane::max(map.thrust_ratio(i, hub, a.sin_pitch), T(min_read_ratio));
        }
    }
    ratios.body_push = T(0);
    if (nominal.has_fountain) {
        ratios.body_push = map.body_ratio(dynamics::center_position(nominal, a, x_m, z_m), a.sin_pitch) - T(1);
    }
    return ratios;
}

/// The free-air thrusts [N] that give a thrust [N] and a pitch torque [N m] if the ratios are right: the shares of
/// allocate() over K. A fountain pushes with its own share of their sum S, which is known before they are: with
/// T_i = (f_i (F - push S) + t_i (T2 + x push S)) / K_i the sum is S = (a F + b T2) / (1 + push (a - x b)), a and b the
/// sums of f_i / K_i and t_i / K_i.
template <class T>
void allocate_against(const PlantModel& nominal, const ReadRatios<T>& ratios, T thrust_n, T pitch_torque_nm,
                      T free_air_n[max_rotors]) {
    if (nominal.has_fountain) {
        T a(0);
        T b(0);
        for (int i = 0; i < nominal.rotor_count; ++i) {
            a = a + T(nominal.force_share[i]) / ratios.rotor[i];
            b = b + T(nominal.torque_share_1_m[i]) / ratios.rotor[i];
        }
        const T x_m(nominal.center_x_m);
        const T push_n =
            ratios.body_push * (a * thrust_n + b * pitch_torque_nm) / (T(1) + ratios.body_push * (a - x_m * b));
        thrust_n = thrust_n - push_n;
        pitch_torque_nm = pitch_torque_nm + x_m * push_n;
    }
    dynamics::allocate(nominal, thrust_n, pitch_torque_nm, free_air_n);
    for (int i = 0; i < nominal.rotor_count; ++i) {
        free_air_n[i] = free_air_n[i] / ratios.rotor[i];
    }
}

/// The wrench of free-air thrusts [N] if the ratios are right.
template <class T>
dynamics::RotorWrench<T> wrench_against(const PlantModel& nominal, const ReadRatios<T>& ratios,
                                        const T free_air_n[max_rotors]) {
    dynamics::RotorWrench<T> wrench{T(0), T(0)};
    T sum_n(0);
    for (int i = 0; i < nominal.rotor_count; ++i) {
        const T acting_n = ratios.rotor[i] * free_air_n[i];
        sum_n = sum_n + free_air_n[i];
        wrench.thrust_n = wrench.thrust_n + acting_n;
        wrench.pitch_torque_nm = wrench.pitch_torque_nm - T(nominal.rotor_x_m[i]) * acting_n;
    }
    const T push_n = ratios.body_push * sum_n;
    wrench.thrust_n = wrench.thrust_n + push_n;
    wrench.pitch_torque_nm = wrench.pitch_torque_nm - T(nominal.center_x_m) * push_n;
    return wrench;
}

}  // namespace downwash::controllers
