#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_model.hpp"

namespace downwash {

/// A problem together with the places of its keys, for programs that change it and read it again.
struct PlacedProblem {
    PlannableProblem plannable;
    std::vector<LocatedError> outdated;  ///< keys that were read under a former name
    std::vector<LocatedError> warnings;  ///< what problem_warnings() finds
    /// Gives remarks on keys the place of the key, or of the nearest key around it, in what was read.
    std::function<std::vector<LocatedError>(const std::vector<KeyError>&)> placed;
};

/// A problem in space together with the places of its keys.
struct PlacedSpaceProblem {
    std::shared_ptr<const SpaceProblemModel> model;  ///< of the problem
    std::vector<LocatedError> outdated;              ///< keys that were read under a former name
    std::vector<LocatedError> warnings;              ///< what space_problem_warnings() finds
    /// As of PlacedProblem.
    std::function<std::vector<LocatedError>(const std::vector<KeyError>&)> placed;
};

/// Reads a problem file; see read_problem(). @throws ProblemFileError
[[nodiscard]] DOWNWASH_EXPORT PlacedProblem read_placed_problem(const std::filesystem::path& file);

/// Reads a problem from the text of a problem file.
/// @param file names the text in messages; paths in the text are relative to its folder
/// @param leaves_out_inapplicable whether keys that have no meaning beside the others are left out, not errors: for
/// documents with every default, of which a group was changed
/// @throws ProblemFileError as read_problem()
[[nodiscard]] DOWNWASH_EXPORT PlacedProblem parse_problem(const std::string& text, const std::filesystem::path& file,
                                                          bool leaves_out_inapplicable = false);

/// Reads the file of a problem in space; see read_space_problem(). @throws ProblemFileError
[[nodiscard]] DOWNWASH_EXPORT PlacedSpaceProblem read_placed_space_problem(const std::filesystem::path& file);

/// Reads a problem in space from the text of a file: see parse_problem(). @throws ProblemFileError
[[nodiscard]] DOWNWASH_EXPORT PlacedSpaceProblem parse_space_problem(const std::string& text,
                                                                     const std::filesystem::path& file,
                                                                     bool leaves_out_inapplicable = false);

/// Reads the values in the text of a problem file without checking the problem as a whole, for programs that take parts
/// of it, such as obstacles and a goal, over into another problem.
/// @param file as for parse_problem()   @throws ProblemFileError with every value that is wrong by itself
[[nodiscard]] DOWNWASH_EXPORT Problem parse_values(const std::string& text, const std::filesystem::path& file);
/// The same of a problem in space.
[[nodiscard]] DOWNWASH_EXPORT SpaceProblem parse_space_values(const std::string& text,
                                                              const std::filesystem::path& file);

/// A new value of a key.
struct KeyChange {
    std::string key;   ///< key with the indices of lists: "planner.seed" or "environment.obstacles[0].box.size_m"
    std::string yaml;  ///< the value as a problem file would have it, in the units of the file; JSON will do
};

/// The problem with other values, read and checked as a whole.
/// @throws InputError with every change that is none: an unknown key, one that has no single value, a wrong value
/// @throws ProblemFileError with every reason why the changed problem cannot be planned
[[nodiscard]] DOWNWASH_EXPORT PlacedProblem changed_problem(const PlacedProblem& before,
                                                            std::span<const KeyChange> changes);

/// The same of a problem in space.
[[nodiscard]] DOWNWASH_EXPORT PlacedSpaceProblem changed_problem(const PlacedSpaceProblem& before,
                                                                 std::span<const KeyChange> changes);

/// The document of effective_yaml() as JSON.
[[nodiscard]] DOWNWASH_EXPORT std::string effective_json(const Problem& problem, const std::filesystem::path& folder);
[[nodiscard]] DOWNWASH_EXPORT std::string effective_json(const SpaceProblem& problem,
                                                         const std::filesystem::path& folder);

}  // namespace downwash
