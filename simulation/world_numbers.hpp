#pragma once

#include "downwash/dynamics/plant_model.hpp"

// How a world differs from what the controller assumes, as numbers for the tick: docs/model.md 9. Nothing is computed
// here: see world_tick.hpp and surroundings.hpp.

namespace downwash::simulation {

/// Greatest delay of the state that the controller sees, in ticks.
inline constexpr int max_delay_ticks = 64;

/// So many ticks every state remembers. Only flights whose controllers see later remember more: see FlightMemory.
inline constexpr int recent_ticks = 3;

/// Standard normal numbers that a world draws for every tick.
inline constexpr int noise_count = 8;

/// Standard normal numbers that a world in space uses in every tick: position and velocity along x, y and z, the three
/// body rates, then the gusts: one along their way, two to its left, two upward.
inline constexpr int space_noise_count = 14;
/// So many are drawn, five from each 64 random bits.
inline constexpr int drawn_space_noise_count = 15;

/// Where and how fast the vehicle was.
template <class T>
struct PastMotion {
    T q[4], u[4];
};

/// What a world remembers of a flight besides the vehicle; all members are T.
template <class T>
struct WorldMemory {
    PastMotion<T> past[recent_ticks];  ///< one tick ago, two ticks ago, ...
    T gust[3];  ///< filter states of the Dryden model, unit variance: x; z, first and second order
};

/// A world in numbers; with a pack every lane flies in a world of its own. All members are T: see base/numbers.hpp.
template <class T>
struct WorldNumbers {
    PlantNumbers<T> plant;                     ///< what really flies, about its true centre of mass
    T center_of_mass_x_m, center_of_mass_z_m;  ///< the multirotor's, in the body frame of the robot file
    T rotor_thrust_scale[max_rotors];          ///< thrust coefficient over the nominal one
    T ground_scale, ceiling_scale;             ///< relative changes of K - 1
    T scene_x_m, scene_z_m;                    ///< displacement of all surfaces
    T arm_wash_scale;                          ///< speed of the slipstreams over that of the model
    T delay_ticks;                             ///< age of what the controller sees, 0 to max_delay_ticks
    T position_bias_m[2], pitch_bias_rad;      ///< constant errors of what it sees
    T position_noise_m, velocity_noise_m_s, gyro_noise_rad_s;  ///< standard deviations, of every tick
    T wind_m_s[2];                                             ///< steady, x and z
    T gust_m_s;                                     ///< standard deviation of the gusts, the same for x and z
    T gust_x_decay, gust_z_decay, gust_z_coupling;  ///< decay of the filters from tick to tick
    T gust_x_noise, gust_z_noise[3];                ///< noise gain of each tick: x; z as Cholesky entries 11, 21, 22
};

}  // namespace downwash::simulation
