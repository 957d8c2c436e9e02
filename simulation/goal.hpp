#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "downwash/base/bounds.hpp"
#include "downwash/base/export.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/contact_goal.hpp"
#include "downwash/simulation/pose.hpp"

namespace downwash {

/// A configuration of vehicle and arm; an empty coordinate is free.
struct ConfigurationGoal {
    std::optional<double> x_m, z_m, arm_rad;
    double tolerance_m = 0.1;                    ///< Euclidean distance over the given coordinates, > 0
    double tolerance_rad = 0.08726646259971647;  ///< Greatest deviation of the arm, modulo a turn; 5 degrees.
    /// Where one of them is given, x and z are judged one by one, each within its own tolerance or, without one, within
    /// tolerance_m.
    std::optional<double> tolerance_x_m = {}, tolerance_z_m = {};
};

/// End effector at a point of the plane; optionally with a direction of the arm (pitch + arm angle).
struct EndEffectorGoal {
    double x_m = 0, z_m = 0;
    double tolerance_m = 0.1;                              ///< Euclidean distance, > 0
    std::optional<double> direction_rad;                   ///< Direction of the arm in the world, a = pitch + arm.
    double direction_tolerance_rad = 0.08726646259971647;  ///< 5 degrees
    /// The tolerances of x and z one by one, as of ConfigurationGoal.
    std::optional<double> tolerance_x_m = {}, tolerance_z_m = {};
};

/// Every kind of goal. What distinguishes kinds asks all of them: geometry in simulation/goal.cpp, keys and errors in
/// problems/goal_kinds.cpp, the judge in judge/goals.cpp. The compiler names the answers that a new kind lacks.
using GoalKind = std::variant<ConfigurationGoal, EndEffectorGoal, ContactGoal>;

/// Where the flight must end and stay. A default Goal leaves every coordinate free, which is an error.
struct Goal {
    GoalKind kind;      ///< Unused if there are alternatives.
    double hold_s = 5;  ///< How long the last reference point is held, >= 1.
    /// Alternatives: the vehicle must reach one of them and hold it as long as that one says; not nested.
    std::vector<Goal> any_of;
    std::optional<Touch> touch;  ///< Follows the hover, at a place of a contact.
    /// What stands for a goal that asks for contact, or has an alternative that does: its alternatives, and for each
    /// contact the places from which the robot can touch. with_touches() finds them.
    std::vector<Goal> places;
};

/// Whether a goal without alternatives asks the robot to touch a surface.
[[nodiscard]] inline bool asks_for_contact(const Goal& goal) noexcept {
    return goal.any_of.empty() && std::holds_alternative<ContactGoal>(goal.kind);
}

/// Whether a goal or one of its alternatives does.
[[nodiscard]] DOWNWASH_EXPORT bool may_touch(const Goal& goal) noexcept;

/// The touch that follows when a reference ends at a point; nullptr where none does.
[[nodiscard]] DOWNWASH_EXPORT const Touch* touch_at(const Goal& goal, const PlantModel& model, const PlanarPose& level);

/// The alternatives of a goal, contacts by their places as far as these were found: the goal itself if it has none.
[[nodiscard]] DOWNWASH_EXPORT std::span<const Goal> alternatives(const Goal& goal) noexcept;

/// How far a vehicle is from a goal, coordinate by coordinate; 0 where the goal leaves it free.
struct GoalDeviation {
    double x_m = 0, z_m = 0;
    double angle_rad = 0;  ///< Turn of the arm or its direction, modulo a turn, >= 0.
};

/// How far a vehicle may be from a goal: (x, z) within a disc or an upright rectangle, and an angle.
struct GoalTolerance {
    double x_m = 0, z_m = 0;  ///< Half widths; a disc has its radius in both.
    bool is_disc = true;
    double angle_rad = 0;

    /// A tolerance that is `share` times as large.
    [[nodiscard]] DOWNWASH_EXPORT GoalTolerance times(double share) const noexcept;

    /// The part that a planned reference may use: usable_tolerance_share.
    [[nodiscard]] DOWNWASH_EXPORT GoalTolerance usable() const noexcept;

    /// The greatest share of the tolerance that a deviation uses; 1 at its boundary.
    [[nodiscard]] DOWNWASH_EXPORT double used_share(const GoalDeviation& deviation) const noexcept;
};

/// The tolerance of a goal without alternatives.
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

/// What of the robot a goal judges.
enum class GoalPart : std::uint8_t {
    end_effector,  ///< The end effector, and the direction of the arm in the world.
    vehicle,       ///< The centre of mass, and the angle of the arm from the vehicle's nose.
};

/// What of the robot a goal without alternatives judges.
[[nodiscard]] DOWNWASH_EXPORT GoalPart part_of(const Goal& goal) noexcept;

/// Closed lines in the plane of motion [m]; what an odd number of them surrounds is inside.
using GoalOutline = std::vector<std::vector<PlaneVector>>;

/// How pictures show a goal: its tolerance around a middle, or an outline.
struct GoalDrawing {
    std::optional<double> x_m, z_m;  ///< The middle; empty: the goal leaves that coordinate free.
    GoalOutline outline;             ///< Where what is judged may be; none: within the tolerance around the middle.
};

/// How pictures show a goal without alternatives.
[[nodiscard]] DOWNWASH_EXPORT GoalDrawing drawing_of(const Goal& goal);

/// Moves a goal and its alternatives upwards, to the millimetre. What is free in z and contacts stay; places are to be
/// found anew.
DOWNWASH_EXPORT void raise_goal(Goal& goal, double by_m);

/// Multiplies the tolerances of place of a goal and its alternatives. Those of contacts stay; places are to be found
/// anew.
DOWNWASH_EXPORT void widen_goal(Goal& goal, double factor);

/// How far a vehicle is from a goal.
struct GoalError {
    double distance_m = 0;  ///< Euclidean, over the coordinates that the goal gives
    double angle_rad = 0;   ///< Turn of the arm or its direction, modulo a turn; 0 when the goal leaves it free.
    double used_share = 0;  ///< The greatest share of a tolerance that is used; see is_met().
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

/// How long the vehicle must meet the goal at the end of the hold [s].
inline constexpr double goal_settling_s = 1.0;
/// The vehicle's centre of mass must be slower than this meanwhile [m/s].
inline constexpr double goal_max_speed_m_s = 0.05;

}  // namespace downwash
