#pragma once

#include <filesystem>
#include <string>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// The problem as a YAML document with every default filled in and the robot inline. Always the same bytes for the same
/// problem; reading them gives the very same problem, to the last bit of every number in use (parameters of models
/// that are switched off are not written).
/// @param folder in which the document will stand: paths of the files that it refers to are relative to it
/// @pre problem_errors(problem) is empty, and every mesh and octree was read from a file
[[nodiscard]] DOWNWASH_EXPORT std::string effective_yaml(const Problem& problem, const std::filesystem::path& folder);

/// Checks that this document could be read again. @pre as for effective_yaml()
/// @throws InputError when it would be too large, or the path of a file that it refers to is not UTF-8
DOWNWASH_EXPORT void require_readable_again(const Problem& problem, const std::filesystem::path& folder);

/// SHA-256 of everything that makes up the problem, as 64 hexadecimal digits. Of files that it refers to, what was read
/// counts, not where they lie. What the robot says of its uncertainty counts as far as the problem takes it over.
[[nodiscard]] DOWNWASH_EXPORT std::string problem_sha256(const Problem& problem);

}  // namespace downwash
