#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash {

/// Larger problem and robot files are refused unread [bytes].
inline constexpr std::size_t largest_document = 32UL * 1024 * 1024;

/// Something wrong, or outdated, in a problem or robot file.
struct LocatedError {
    std::string file;     ///< The file as the caller or the problem file names it.
    int line = 1;         ///< Counted from 1.
    int column = 1;       ///< In bytes, counted from 1.
    std::string message;  ///< What is wrong, what was expected, and the nearest valid name or another remedy.
};

/// "file:line:column: message"
[[nodiscard]] DOWNWASH_EXPORT std::string to_text(const LocatedError& error);

/// A problem or robot file cannot be used; what() has one line for every error.
class DOWNWASH_EXPORT ProblemFileError : public std::runtime_error {
 public:
    /// @pre there is at least one error
    explicit ProblemFileError(std::vector<LocatedError> errors);
    [[nodiscard]] const std::vector<LocatedError>& errors() const noexcept { return errors_; }

 private:
    std::vector<LocatedError> errors_;
};

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

/// Reads a robot from a file of its own. @throws ProblemFileError
/// @param on_warning is told of everything that robot_warnings() finds
[[nodiscard]] DOWNWASH_EXPORT Robot read_robot(const std::filesystem::path& file,
                                               const std::function<void(const LocatedError&)>& on_warning = {});

/// Sets one value as a problem file would, for example ("planner.variant", "mp-arm") or ("planner.seed", "7").
/// The problem is not checked as a whole.
/// @throws InputError when there is no such key, or the text is not a value for it
DOWNWASH_EXPORT void set_parameter(Problem& problem, std::string_view key, std::string_view text);

}  // namespace downwash
