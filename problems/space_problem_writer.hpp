#pragma once

#include <filesystem>
#include <string>

#include "downwash/base/export.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// The problem as a YAML document with every default filled in and the robot inline: see the effective_yaml() of a
/// planar problem. @pre space_problem_errors(problem) is empty, and every mesh and octree was read from a file
[[nodiscard]] DOWNWASH_EXPORT std::string effective_yaml(const SpaceProblem& problem,
                                                         const std::filesystem::path& folder);

/// SHA-256 of everything that makes up the problem, as 64 hexadecimal digits: see the problem_sha256() of a planar one.
[[nodiscard]] DOWNWASH_EXPORT std::string problem_sha256(const SpaceProblem& problem);

/// The file of a robot in space, with every default filled in. Reading it gives the very same robot, to the last bit of
/// every number. @pre space_robot_errors(robot) is empty
[[nodiscard]] DOWNWASH_EXPORT std::string robot_yaml(const SpaceRobot& robot);

}  // namespace downwash
