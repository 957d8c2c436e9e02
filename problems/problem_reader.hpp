#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "downwash/base/checks.hpp"
#include "downwash/base/export.hpp"
#include "downwash/problems/located_error.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash {

/// Reads a problem and the robot that it refers to, whose path is relative to the problem's file.
/// The result is complete and sound: problem_errors() finds nothing in it.
/// @param adjust changes values before the problem is checked as a whole, for example with set_parameter()
/// @param on_outdated is told of every key that the file calls by a former name; the key is read all the same
/// @param on_warning is told of everything that problem_warnings() finds
/// @throws ProblemFileError with every error that can be found in one reading (a hundred at most), and what adjust does
[[nodiscard]] DOWNWASH_EXPORT Problem read_problem(const std::filesystem::path& file,
                                                   const std::function<void(Problem&)>& adjust = {},
                                                   const std::function<void(const LocatedError&)>& on_outdated = {},
                                                   const std::function<void(const LocatedError&)>& on_warning = {});

/// Reads a problem like read_problem(), with the flight model in the scene that was made for the checks.
[[nodiscard]] DOWNWASH_EXPORT PlannableProblem
read_plannable_problem(const std::filesystem::path& file, const std::function<void(Problem&)>& adjust = {},
                       const std::function<void(const LocatedError&)>& on_outdated = {},
                       const std::function<void(const LocatedError&)>& on_warning = {});

/// What a problem's file says, whether or not it can be planned.
struct ProblemReading {
    Problem problem;                   ///< with defaults where keys are wrong
    std::vector<LocatedError> errors;  ///< every error that read_problem() finds
    std::vector<LocatedError>
        warnings;     ///< keys by former names, and problem_warnings(); with errors those of files only
    WrongKeys wrong;  ///< the keys of all errors
    std::shared_ptr<const Scene> scene;        ///< null if an obstacle has an error
    std::shared_ptr<const FlightModel> model;  ///< null if environment, robot or surface effects have an error
};

/// Reads a problem for programs that show what was read beside its errors. Throws nothing for an unsound file.
[[nodiscard]] DOWNWASH_EXPORT ProblemReading examine_problem(const std::filesystem::path& file);

/// Reads a robot from a file of its own. @throws ProblemFileError
/// @param on_warning is told of keys by their former names and of everything that robot_warnings() finds
[[nodiscard]] DOWNWASH_EXPORT Robot read_robot(const std::filesystem::path& file,
                                               const std::function<void(const LocatedError&)>& on_warning = {});

/// Sets one value as a problem file would, for example ("planner.variant", "mp-arm") or ("planner.seed", "7").
/// The problem is not checked as a whole.
/// @throws InputError when there is no such key, or the text is not a value for it
DOWNWASH_EXPORT void set_parameter(Problem& problem, std::string_view key, std::string_view text);

}  // namespace downwash
