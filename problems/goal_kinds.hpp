#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/problems/problem_check.hpp"

// What distinguishes the kinds of goals in problem files: their keys, and what can be wrong with their values.

namespace downwash {

/// The keys of every kind of goal, below those of the goal.
[[nodiscard]] std::vector<Parameter<Goal>> goal_kind_rows();

/// The keys of a configuration, below what is one without its group.
[[nodiscard]] std::vector<Parameter<Goal>> configuration_rows();

/// Name of the group of keys that a kind has: "end_effector".
[[nodiscard]] std::string_view name_of(const GoalKind& kind);

/// What a goal's own values leave unclear. @param key of the kind's group, as for the functions below
[[nodiscard]] std::vector<KeyError> unclear_values(const Goal& goal, const std::string& key);

/// Coordinates that are outside the bounds by more than their tolerance.
[[nodiscard]] std::vector<KeyError> places_outside_bounds(const Goal& goal, const Problem& problem,
                                                          const std::string& key);

/// Angles that the arm cannot turn to within the tolerance.
[[nodiscard]] std::vector<KeyError> angles_beyond_limits(const Goal& goal, const Problem& problem,
                                                         const std::string& key);

/// Why no pose of the robot meets the goal; empty as well where there are too many poses to try.
/// @throws InputError when an obstacle cannot be placed
[[nodiscard]] std::vector<KeyError> goal_out_of_reach(const Goal& goal, const ProblemCheck& check,
                                                      const std::string& key);

/// "-90 to 90": the arm's limits in degrees. @pre it has some
[[nodiscard]] std::string arm_limits_text(const ArmParameters& arm);

}  // namespace downwash
