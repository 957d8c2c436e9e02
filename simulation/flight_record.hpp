#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "downwash/simulation/contact_goal.hpp"
#include "downwash/simulation/flight.hpp"

// What execute() tells of a flight.

namespace downwash {

/// How an executed plan ended.
enum class Outcome : std::uint8_t {
    ok,
    collision,
    unstable,
    left_flyable_area,
    goal_missed,
    over_budget,  ///< met its goals, but took more energy than it may
};

inline constexpr std::array all_outcomes{Outcome::ok,          Outcome::collision,
                                         Outcome::unstable,    Outcome::left_flyable_area,
                                         Outcome::goal_missed, Outcome::over_budget};

/// The largest magnitude of a number of a flight or of a file of results, infinite clearances apart. A flight with a
/// larger one counts as unstable.
inline constexpr double max_result = 1e30;
/// The largest magnitude of a number of a vehicle's state; what follows from it is then within max_result.
inline constexpr double max_state = 1e20;

/// The vehicle at one control tick and the commands it holds until the next; SI units, plane coordinates.
struct FlightRow {
    double t_s = 0;
    ReferencePoint reference;
    double q[4] = {};                         ///< x, z, pitch, arm
    double u[4] = {};                         ///< their rates
    double rotor_command_n[max_rotors] = {};  ///< free-air thrust, after clipping
    double rotor_factor[max_rotors] = {};     ///< surface effect K at t_s
    double rotor_lag_n[max_rotors] = {};      ///< thrust that the lag has reached; meaningful with rotor lag only
    double thrust_command_n = 0;              ///< sum of the rotor commands
    double pitch_torque_command_nm = 0;       ///< -sum x_i T_i of the rotor commands
    double arm_torque_nm = 0;
    double thrust_n = 0;  ///< thrust in aerodynamic effect, at t_s
    double pitch_torque_nm = 0;
    double clearance_m = 0;  ///< infinity without obstacles
    double end_effector_x_m = 0;
    double end_effector_z_m = 0;
    double power_w = 0;
    double energy_j = 0;         ///< spent since the start
    double contact_force_n = 0;  ///< normal force of a surface that the robot touches, mean over the tick before
};

/// The outcome of one goal of a flight.
struct GoalVisit {
    bool is_met = false;               ///< throughout the last second of its hover, and of that after its touch
    double error_m = 0;                ///< worst over these seconds, or where the flight ended before
    std::optional<TouchRecord> touch;  ///< where it asks for one and the flight came to it
};

/// A plan flown from start to the end of the hold.
struct Execution : FlightSums {
    bool aero = true;  ///< whether surfaces acted on the rotors
    Outcome outcome = Outcome::ok;
    double min_clearance_m = 0;  ///< infinity without obstacles; a touch does not count
    double energy_j = 0;
    double duration_s = 0;
    double clearance_integral = 0;  ///< see SegmentFlight
    double max_tracking_error_m = 0;
    double max_saturation = 0;     ///< greatest demand over its limit; above 1 something was clipped
    double goal_error_m = 0;       ///< the worst of all goals
    double lateral_m = 0;          ///< how far the vehicle was to the left of its plane; see FlownWorld
    std::vector<GoalVisit> goals;  ///< one for each, in their order
    /// Share of the control ticks at which a part of the robot is in space that no sensor saw and that counts as free
    /// (Scene::unseen_space()); empty if the scene has none.
    std::optional<double> unseen_share;
    int rotor_count = 0;
    bool has_rotor_lag = false;
    /// One per control tick, the last one at the end of the flight, or one tick before where its numbers at the end are
    /// beyond max_result. Commands beyond it are 0.
    std::vector<FlightRow> rows;
};

}  // namespace downwash
