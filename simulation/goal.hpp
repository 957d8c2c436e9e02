#pragma once

#include <optional>
#include <span>
#include <vector>

#include "downwash/base/bounds.hpp"
#include "downwash/base/export.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/contact_goal.hpp"
#include "downwash/simulation/pose.hpp"

namespace downwash {

/// End effector at a point of the plane; optionally with a direction of the arm (pitch + arm angle).
struct EndEffectorGoal {
    double x_m = 0, z_m = 0;
    double tolerance_m = 0.1;                              ///< Euclidean distance, > 0
    std::optional<double> direction_rad;                   ///< of the arm in the world, a = pitch + arm
    double direction_tolerance_rad = 0.08726646259971647;  ///< 5 degrees
    /// Where one of them is given, x and z are judged one by one, each within its own tolerance or, without one, within
    /// tolerance_m.
    std::optional<double> tolerance_x_m = {}, tolerance_z_m = {};
};

/// A configuration of vehicle and arm; an empty coordinate is free.
struct ConfigurationGoal {
    std::optional<double> x_m, z_m, arm_rad;
    double tolerance_m = 0.1;                    ///< Euclidean distance over the given coordinates, > 0
    double tolerance_rad = 0.08726646259971647;  ///< of the arm, modulo a turn; 5 degrees
    /// As for the end effector.
    std::optional<double> tolerance_x_m = {}, tolerance_z_m = {};
};

/// Where the flight must end and stay. Exactly one of end_effector, configuration, any_of and contact is set; to
/// contact belong the alternatives that with_touches() finds.
struct Goal {
    std::optional<EndEffectorGoal> end_effector;
    std::optional<ConfigurationGoal> configuration;
    std::optional<ContactGoal> contact;  ///< the force is held for hold_s
    double hold_s = 5;                   ///< the last reference point is held for so long, >= 1
    std::vector<Goal>
        any_of;  ///< alternatives: the vehicle must reach one of them and hold it as long as that one says; not nested
    std::optional<Touch> touch;  ///< follows the hover, where an alternative belongs to a contact
};

/// The touch that follows when a reference ends at a point; nullptr where none does.
[[nodiscard]] DOWNWASH_EXPORT const Touch* touch_at(const Goal& goal, const PlantModel& model, const PlanarPose& level);

/// The alternatives of a goal: the goal itself if it names none.
[[nodiscard]] DOWNWASH_EXPORT std::span<const Goal> alternatives(const Goal& goal) noexcept;

/// How far a vehicle is from a goal, coordinate by coordinate; 0 where the goal leaves it free.
struct GoalDeviation {
    double x_m = 0, z_m = 0;
    double angle_rad = 0;  ///< of the arm or its direction, modulo a turn, >= 0
};

/// How far that may be: (x, z) within a disc or an upright rectangle, and an angle.
struct GoalTolerance {
    double x_m = 0, z_m = 0;  ///< half widths; of a disc its radius
    bool is_disc = true;
    double angle_rad = 0;

    /// So large a part of it.
    [[nodiscard]] DOWNWASH_EXPORT GoalTolerance times(double share) const noexcept;

    /// The part that a planned reference may use: usable_tolerance_share.
    [[nodiscard]] DOWNWASH_EXPORT GoalTolerance usable() const noexcept;

    /// The greatest share of the tolerance that a deviation uses; 1 at its boundary.
    [[nodiscard]] DOWNWASH_EXPORT double used_share(const GoalDeviation& deviation) const noexcept;
};

/// Of a goal without alternatives.
[[nodiscard]] DOWNWASH_EXPORT GoalTolerance tolerance_of(const Goal& goal) noexcept;

/// The deviation of a pose from a goal without alternatives.
[[nodiscard]] DOWNWASH_EXPORT GoalDeviation goal_deviation(const Goal& goal, const PlantModel& model,
                                                           const PlanarPose& pose);

/// The arm angle with which the level vehicle has the angle that a goal without alternatives asks for; empty when the
/// goal leaves it free.
[[nodiscard]] DOWNWASH_EXPORT std::optional<double> level_arm_rad(const Goal& goal) noexcept;

/// Inverse kinematics: the level vehicle that deviates by (dx, dz) [m] from a goal without alternatives, with its arm
/// as it stands. What the goal leaves free is kept.
[[nodiscard]] DOWNWASH_EXPORT Configuration placed_at(const Goal& goal, const PlantModel& model,
                                                      Configuration configuration, double dx_m, double dz_m);

/// How far a vehicle is from a goal.
struct GoalError {
    double distance_m = 0;  ///< Euclidean, over the coordinates that the goal gives
    double angle_rad = 0;   ///< of the arm or its direction, modulo a turn; 0 when the goal leaves it free
    double used_share = 0;  ///< the greatest share of a tolerance that is used; see is_met()
};

/// The error of a pose; among alternatives that of the nearest.
[[nodiscard]] DOWNWASH_EXPORT GoalError goal_error(const Goal& goal, const PlantModel& model, const PlanarPose& pose);

/// The alternative whose tolerances a pose uses least; the first of equals.
[[nodiscard]] DOWNWASH_EXPORT const Goal& nearest_goal(const Goal& goal, const PlantModel& model,
                                                       const PlanarPose& pose);

/// Whether the error lies within the goal's tolerances.
[[nodiscard]] inline bool is_met(const GoalError& error) noexcept {
    return error.used_share <= 1;
}

/// The greatest motion of any point of the robot after which a pose surely still meets the goal [m]; negative if it
/// does not meet the goal now.
/// @param body_reach_m a turn of the body moves some point of the robot with this reach [m], > 0
[[nodiscard]] DOWNWASH_EXPORT double motion_within_goal_m(const Goal& goal, const PlantModel& model,
                                                          const PlanarPose& pose, double body_reach_m);

/// The share of each tolerance that a planned reference may use. The rest is for the tracking error of the flight.
inline constexpr double usable_tolerance_share = 0.9;

/// The vehicle must meet the goal during this time at the end of the hold [s], ...
inline constexpr double goal_settling_s = 1.0;
/// ... with the vehicle's centre of mass slower than this [m/s].
inline constexpr double goal_max_speed_m_s = 0.05;

}  // namespace downwash
