#pragma once

// Private: not installed.

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "downwash/problems/space_problem.hpp"
#include "downwash/problems/visit_order.hpp"

namespace downwash {

/// Name, bodies, rotors, arm and end effector of a robot, each in the frame of what it belongs to.
[[nodiscard]] nlohmann::ordered_json robot_drawing_json(const SpaceRobot& robot);

/// Adds to a page, in the coordinates of the world: scene, robot, start, goals, limits and facts of a problem in space.
/// @param order in which its targets are visited; empty: none, or it is not known
/// @pre space_problem_errors(problem) is empty
void add_space_problem(nlohmann::ordered_json& page, const SpaceProblem& problem,
                       const std::optional<VisitOrder>& order);

}  // namespace downwash
