#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/located_error.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// Whether the file of a problem is one in space: its bounds have y_m. A file that cannot be read is not.
[[nodiscard]] DOWNWASH_EXPORT bool is_space_problem_file(const std::filesystem::path& file);

/// The same for the text of a file.
[[nodiscard]] DOWNWASH_EXPORT bool is_space_problem_text(const std::string& text);

/// Whether the file of a robot is one in space: it has keys that only such robots have, as multirotor.inertia_kg_m2. A
/// file that cannot be read is not.
[[nodiscard]] DOWNWASH_EXPORT bool is_space_robot_file(const std::filesystem::path& file);

/// Reads a problem in space and the robot that it refers to: see read_problem(). The result is complete and sound:
/// space_problem_errors() finds nothing in it.
/// @param adjust changes values before the problem is checked as a whole
/// @param on_warning is told of keys by their former names and of everything that space_problem_warnings() finds
/// @param further_errors what else speaks against a sound problem; located like all errors
/// @throws ProblemFileError with every error that can be found in one reading (a hundred at most), and what adjust does
[[nodiscard]] DOWNWASH_EXPORT SpaceProblem
read_space_problem(const std::filesystem::path& file, const std::function<void(SpaceProblem&)>& adjust = {},
                   const std::function<void(const LocatedError&)>& on_warning = {},
                   const std::function<std::vector<KeyError>(const SpaceProblem&)>& further_errors = {});

/// Reads a robot in space from a file of its own. @throws ProblemFileError
/// @param on_warning is told of keys by their former names and of everything that space_robot_warnings() finds
[[nodiscard]] DOWNWASH_EXPORT SpaceRobot
read_space_robot(const std::filesystem::path& file, const std::function<void(const LocatedError&)>& on_warning = {});

}  // namespace downwash
