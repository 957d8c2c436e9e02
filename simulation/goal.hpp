#pragma once

#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/dynamics/plant_model.hpp"

namespace downwash {

/// Limits of the multirotor's centre of mass, plane coordinates [m].
struct Bounds {
    double x_low_m = 0, x_high_m = 0;
    double z_low_m = 0, z_high_m = 0;
};

/// End effector at a point of the plane; optionally with a direction of the arm (pitch + arm angle).
struct EndEffectorGoal {
    double x_m = 0, z_m = 0;
    double tolerance_m = 0.1;                              ///< Euclidean distance, > 0
    std::optional<double> direction_rad;                   ///< of the arm in the world, a = pitch + arm
    double direction_tolerance_rad = 0.08726646259971647;  ///< 5 degrees
};

/// A configuration of vehicle and arm; an empty coordinate is free.
struct ConfigurationGoal {
    std::optional<double> x_m, z_m, arm_rad;
    double tolerance_m = 0.1;                    ///< Euclidean distance over the given coordinates, > 0
    double tolerance_rad = 0.08726646259971647;  ///< of the arm, modulo a turn; 5 degrees
};

/// Where the flight must end and stay. Exactly one of the two kinds is set.
struct Goal {
    std::optional<EndEffectorGoal> end_effector;
    std::optional<ConfigurationGoal> configuration;
    double hold_s = 5;  ///< the last reference point is held for so long, >= 1
};

/// How far a vehicle is from a goal.
struct GoalError {
    double distance_m = 0;  ///< Euclidean, over the coordinates that the goal gives
    double angle_rad = 0;   ///< of the arm or its direction, modulo a turn; 0 when the goal leaves it free
};

/// The error of a configuration q = (x, z, pitch, arm) [m, m, rad, rad].
[[nodiscard]] DOWNWASH_EXPORT GoalError goal_error(const Goal& goal, const PlantModel& model, const double q[4]);

/// Whether the error lies within the goal's tolerances.
[[nodiscard]] DOWNWASH_EXPORT bool is_met(const Goal& goal, const GoalError& error);

/// The share of each tolerance that a reference may use up while planning; the rest is left to the flight.
inline constexpr double usable_tolerance_share = 0.9;

/// The goal must be met over so long at the end of the hold [s], ...
inline constexpr double goal_settling_s = 1.0;
/// ... with the vehicle's centre of mass slower than this [m/s].
inline constexpr double goal_max_speed_m_s = 0.05;

}  // namespace downwash
