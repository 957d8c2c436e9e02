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

/// How much farther the arm would have to reach for an end-effector goal from within the bounds [m]; <= 0 when it is
/// within reach. Exact, obstacles and limits of the arm apart. @pre wanted.end_effector is set
[[nodiscard]] double missing_reach_m(const Problem& problem, const Goal& wanted);

/// Tries poses around an end-effector goal, half a degree of arm apart. @pre wanted.end_effector is set
[[nodiscard]] Reach reach_of_end_effector(const ProblemCheck& check, const Goal& wanted);

/// Tries poses within the tolerances of a configuration goal; true when a coordinate is free, as then there are too
/// many to say no. @pre wanted.configuration is set
[[nodiscard]] bool has_clear_configuration(const ProblemCheck& check, const Goal& wanted);

}  // namespace downwash
