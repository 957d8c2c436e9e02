#pragma once

#include "downwash/controllers/space_reference.hpp"
#include "downwash/dynamics/space_body.hpp"
#include "downwash/simulation/world_numbers.hpp"

// How a world in space differs from what the controller assumes, as numbers for the tick: docs/model.md 9.1. Nothing is
// computed here: see space_world_tick.hpp and space_surroundings.hpp. world_numbers.hpp has those of the plane.

namespace downwash::simulation {

/// Where and how fast a vehicle in space with n joints was; coordinates and speeds as in dynamics/space_body.hpp.
template <class T, int n>
struct PastSpaceMotion {
    T q[dynamics::space_coordinates<n>], u[dynamics::space_speeds<n>];
};

/// What a world remembers of a flight besides the vehicle; all members are T.
template <class T, int n>
struct SpaceWorldMemory {
    PastSpaceMotion<T, n> past[recent_ticks];  ///< one tick ago, two ticks ago, ...
    /// Filter states of the gusts, unit variance: along; to the left, first and second order; upward, both.
    T gust[5];
};

/// The filter of a gust across its way; see GustPairFilter.
template <class T>
struct GustPairNumbers {
    T decay, coupling, noise[3];
};

/// What differs in a world besides plant and joints. All members are T: see base/numbers.hpp.
template <class T>
struct SpaceWorldDifferences {
    dynamics::LaneVector<T> center_of_mass_m;  ///< the multirotor's, in the body frame of the robot file
    T rotor_thrust_scale[max_rotors];          ///< thrust coefficient over the nominal one
    T ground_scale, ceiling_scale;             ///< relative changes of K - 1
    dynamics::LaneVector<T> scene_m;           ///< displacement of all surfaces, after their turn
    T scene_cosine, scene_sine;                ///< of their turn about the z axis of the world
    T wash_scale;                              ///< speed of the slipstreams over that of the model
    T delay_ticks;                             ///< age of what the controller sees, 0 to max_delay_ticks
    dynamics::LaneVector<T> position_bias_m;   ///< constant errors of what it sees
    T attitude_bias[4];                        ///< a turn about body axes as a quaternion (w, x, y, z) of length 1
    T position_noise_m, velocity_noise_m_s, gyro_noise_rad_s;  ///< standard deviations, of every tick
    dynamics::LaneVector<T> wind_m_s;                          ///< steady
    T gust_m_s;                ///< standard deviation of the gusts, the same in every direction
    T gust_cosine, gust_sine;  ///< of the level direction in which gusts pass, from the x axis of the world
    T gust_decay, gust_noise;  ///< filter of the gust along that way
    GustPairNumbers<T> gust_left, gust_up;
};

/// A world in numbers; with a pack every lane flies in a world of its own. All members are T.
template <class T, int n>
struct SpaceWorldNumbers : SpaceWorldDifferences<T> {
    SpaceNumbers<T, n> plant;         ///< what really flies, about its true centre of mass
    T joint_offset_rad[room_for<n>];  ///< what the controller sees of each joint less its angle
};

}  // namespace downwash::simulation
