#pragma once

#include "downwash/problems/problem_check.hpp"

namespace downwash {

/// Whether a robot that hovers level can be where its goal wants it.
enum class Reach {
    clear,    ///< some pose gets there and keeps clear of obstacles
    blocked,  ///< poses get there, and all of them touch an obstacle or are nearer than the safety margin
    none,     ///< no pose gets there
};

/// Whether the arm's limits let it turn to an angle, modulo a turn, give or take a tolerance [rad].
[[nodiscard]] bool arm_can_turn_to(const ArmParameters& arm, double angle_rad, double tolerance_rad);

/// How much farther the arm would have to reach for a goal from within the bounds [m]; <= 0 when it is within reach.
/// Exact, obstacles and limits of the arm apart.
[[nodiscard]] double missing_reach_m(const Problem& problem, const EndEffectorGoal& goal,
                                     const GoalTolerance& tolerance);

/// Tries poses within the part of a goal's tolerances that a plan may use, half a degree of arm apart.
/// @pre wanted has no alternatives, and leaves the place of the vehicle free by nothing but the angle of its arm
[[nodiscard]] Reach reach_of(const ProblemCheck& check, const Goal& wanted);

}  // namespace downwash
