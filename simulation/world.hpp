#pragma once

#include <cstdint>

#include "downwash/base/export.hpp"
#include "downwash/dynamics/plant_state.hpp"
#include "downwash/simulation/flight_memory.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/world_numbers.hpp"

namespace downwash {

/// A world: its differences from the nominal numbers, unknown to controller and planner. All zero is the nominal world.
/// docs/model.md 9 says what each of them changes.
struct World {
    double ceiling_scale = 0;  ///< Relative change of K - 1 under surfaces.
    double ground_scale = 0;   ///< Relative change of K - 1 over surfaces.
    double scene_x_m = 0;      ///< Displacement of all surfaces and obstacles; y is to the left, of obstacles alone.
    double scene_y_m = 0;
    double scene_z_m = 0;
    double mass_scale = 0;          ///< Relative change of the multirotor's mass.
    double inertia_scale = 0;       ///< Relative change of both inertias.
    double arm_mass_scale = 0;      ///< Relative change of the arm's mass.
    double center_of_mass_x_m = 0;  ///< Place of the multirotor's centre of mass, in the body frame.
    double center_of_mass_z_m = 0;
    double thrust_scale = 0;                     ///< Relative change of the thrust of all rotors.
    double rotor_thrust_scale[max_rotors] = {};  ///< Relative change of the thrust of each rotor.
    double arm_wash_scale = 0;                   ///< Relative change of the slipstreams' speed at the arm.
    double rotor_time_constant_s = 0;            ///< Added to that of the robot.
    double delay_s = 0;                          ///< Added to that of the robot.
    double position_bias_x_m = 0;                ///< Constant error of the position that the controller sees.
    double position_bias_y_m = 0;
    double position_bias_z_m = 0;
    double pitch_bias_rad = 0;  ///< Constant error of the pitch that the controller sees.
    double wind_x_m_s = 0;      ///< Steady wind.
    double wind_y_m_s = 0;
    double wind_z_m_s = 0;
    double gust_y_m_s = 0;       ///< A gust from the right as long as the flight.
    double lateral_error_m = 0;  ///< How far the loop across the plane lets the vehicle be to the left of it.

    // Alike in every world of a problem but the nominal one.
    double position_noise_m = 0;  ///< Standard deviations of what the controller sees, anew in every tick.
    double velocity_noise_m_s = 0;
    double gyro_noise_rad_s = 0;
    double gust_m_s = 0;         ///< Standard deviation of the Dryden gusts, along x and along z.
    double gust_length_x_m = 1;  ///< Length scales of the gusts.
    double gust_length_z_m = 1;

    std::uint64_t tape = 0;  ///< Selects the noise and the gusts.
};

/// A world as a flight needs it.
struct FlownWorld {
    World world;
    simulation::WorldNumbers<double> numbers;
    bool has_noise;        ///< Noise in what the controller sees, or gusts.
    double lateral_m = 0;  ///< How far the vehicle is to the left of where its obstacles have the plane.
};

/// Prepares a world for the tick.
/// @pre robot_errors(robot) is empty; scales are above -1, the rotors' time constant stays at least half a tick where
/// the robot has a lag, and the delay stays within 0 and simulation::max_delay_ticks, but for rounding
[[nodiscard]] DOWNWASH_EXPORT FlownWorld make_world(const Robot& robot, const World& world);

/// A world without its noise and gusts.
[[nodiscard]] DOWNWASH_EXPORT FlownWorld without_noise(const FlownWorld& world) noexcept;

/// What a world remembers as a flight begins: the vehicle was always in this state, and gusts blow already.
[[nodiscard]] DOWNWASH_EXPORT simulation::FlightMemory memory_at_start(
    const FlownWorld& world, const dynamics::PlantState<double>& state) noexcept;

}  // namespace downwash
