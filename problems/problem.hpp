#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/aeromap/aero_settings.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/reference_segment.hpp"
#include "downwash/problems/objective.hpp"
#include "downwash/scene/collision_checker_kind.hpp"
#include "downwash/scene/plane_of_motion.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/uncertainty.hpp"

namespace downwash {

/// What the planner knows of the physics while it plans (thesis C.2).
enum class Variant {
    mp_arm,      ///< geometry only: lines of (x, z, arm), which the level vehicle follows exactly
    mp_arm_da,   ///< dynamics-aware: closed-loop flights without surface effects
    mp_arm_ada,  ///< aerodynamics-aware: closed-loop flights through the aero map
};

/// Each once, in their order.
inline constexpr std::array all_variants{Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada};

/// Whether the edges of a variant are flights; those of the other one are lines.
[[nodiscard]] constexpr bool plans_flights(Variant variant) noexcept {
    return variant != Variant::mp_arm;
}

/// Name as in problem files: "mp-arm-ada".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(Variant variant);

/// Where the flight begins. A vehicle in the middle of a flight has more to it than where it is and how it moves: the
/// reference that it follows, what its rotors give and what its controller remembers.
struct Start {
    Configuration at;  ///< where vehicle and arm are, the pitch left out
    double pitch_rad = 0;
    double velocity[max_axes]{};  ///< velocity along each axis [m/s or rad/s]
    double pitch_rate_rad_s = 0;
    /// Reference with which the plan begins; empty: where the vehicle is, as it moves.
    std::optional<ReferencePoint> reference;
    /// Free-air thrust that the rotors' lag has reached [N], of each rotor; empty: they carry the weight.
    std::vector<double> rotor_thrust_n;
    /// Numbers of the control law's memory, in the order of its Memory; empty: that of a vehicle that has hovered long.
    std::vector<double> controller_memory;

    [[nodiscard]] PlanarPose pose() const noexcept { return {at[plane::x], at[plane::z], pitch_rad, at[plane::arm]}; }

    /// A vehicle that rests at a configuration.
    [[nodiscard]] static Start resting_at(const Configuration& configuration) {
        Start start;
        start.at = configuration;
        return start;
    }
};

/// Whether nothing moves at the start, and a vehicle may have hovered there for long: none that is in a flight already.
[[nodiscard]] inline bool is_at_rest(const Start& start) noexcept {
    return std::ranges::all_of(start.velocity, [](double rate) { return rate == 0; }) && start.pitch_rate_rad_s == 0 &&
           !start.reference && start.rotor_thrust_n.empty() && start.controller_memory.empty();
}

/// Wall time of a search that is limited by nothing else [s].
inline constexpr double default_time_limit_s = 10;

/// Parameters of an algorithm by the names that algorithms() lists.
using ParameterValues = std::map<std::string, double, std::less<>>;

/// How to search.
struct PlannerSettings {
    Variant variant = Variant::mp_arm_ada;
    std::string algorithm = "rrt-star";  ///< One of the names that algorithms() lists.
    CostFunction objective = Objective::energy;
    /// Wall time of the search [s], > 0. Empty: default_time_limit_s, or none where max_iterations is set.
    std::optional<double> time_limit_s;
    std::optional<std::uint64_t> max_iterations;  ///< Set it for a run that is repeatable bit for bit.
    std::uint32_t seed = 1;
    double safety_margin_m = 0.05;  ///< Least clearance while planning, >= 0.
    double max_saturation = 1;      ///< Greatest demand over its limit, of a rotor or the joint while planning, >= 1.
    std::optional<double> max_pitch_rate_rad_s;  ///< Limit of the vehicle while planning, > 0; empty: any.
    /// Who computes collisions and clearances. In executed flights FCL decides contact, whatever stands here.
    CollisionCheckerKind collision_checker = CollisionCheckerKind::own;
    // Where the problem has an uncertainty:
    std::uint64_t worlds = 8;               ///< Worlds that every edge has to survive, the nominal one included, >= 1.
    double max_failure_probability = 0.01;  ///< Limit for a plan that is called solved, in (0, 1).
    double confidence = 0.95;               ///< Confidence of that limit, in (0, 1).
    bool certify = true;                    ///< Whether only a plan with a certificate counts.
    /// Whether a plan counts only once it was executed well with direct aerodynamics.
    bool check_execution = true;
    ParameterValues parameters;  ///< Parameters of the algorithm that differ from their defaults.
};

/// A motion planning problem for an aerial manipulator, complete in itself.
struct Problem {
    std::string name = "problem";  ///< [A-Za-z0-9_-]{1,64}
    std::string description;
    Robot robot;
    PlaneOfMotion plane;
    Bounds bounds;
    std::vector<Obstacle> obstacles;
    AeroSettings aero;
    std::optional<Uncertainty> uncertainty;  ///< Nothing: everything is nominal.
    Start start;
    /// Goals to be reached and held before `goal`, in this order, without alternatives.
    std::vector<Goal> goals_before;
    Goal goal;
    std::vector<Goal> targets;  ///< Goals in an order that the planner chooses; any replace `goals_before` and `goal`.
    std::optional<Goal> return_to;          ///< A configuration to be reached and held after the targets.
    std::optional<double> energy_budget_j;  ///< No flight may take more, > 0; targets beyond it are left out.
    MotionLimits motion;
    PlannerSettings planner;

    /// The axes of the vehicle's references.
    [[nodiscard]] constexpr std::span<const Axis> axes() const noexcept { return planar_axes; }
};

/// More goals than these, in a row or to choose from, are not planned for.
inline constexpr std::size_t max_goals = 64;

/// More targets than these are not planned for in any order.
inline constexpr std::size_t max_targets = 50;

/// All goals in the order in which they are to be visited: `goals_before`, then `goal`. Targets in any order come as
/// they stand in the file, then the place to return to; see in_order().
[[nodiscard]] DOWNWASH_EXPORT std::vector<Goal> goals_of(const Problem& problem);

/// Every reason why a problem cannot be planned: numbers out of range, a robot that cannot fly, a start in collision
/// or outside the flyable area, a goal out of reach. Keys are key paths of a problem file. Empty when it is sound.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> problem_errors(const Problem& problem);

/// What of a start does not belong to the robot: too many or too few rotor thrusts, or numbers of the controller's
/// memory. Part of problem_errors().
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> start_errors(const Start& start, const Robot& robot);

/// What can be planned but is likely not meant: a controller that does not hold a hover in free air, overlapping rotor
/// discs, rotors that roll the vehicle, gains of zero, a power far from usual, no safety margin, a goal that is met at
/// the start, an uncertainty of nothing, a mesh that is not closed or far from all flights. Keys are key paths of a
/// problem file. @pre problem_errors(problem) is empty
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> problem_warnings(const Problem& problem);

/// Those of a robot alone; keys are relative to the robot. Empty when it has errors.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> robot_warnings(const Robot& robot);

}  // namespace downwash
