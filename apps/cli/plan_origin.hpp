#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash::cli {

/// Whether a plan was made for a problem other than `problem`; planner settings do not count. Where the file has no run
/// folder beside it, settings do count, as only their common checksum is known. A plan written by hand names no
/// problem; if its file has a certificate, that counts as another problem's.
[[nodiscard]] bool is_of_another_problem(const std::filesystem::path& plan, bool has_certificate, Problem problem);
/// The same of a plan in space, which has no certificate.
[[nodiscard]] bool is_of_another_problem(const std::filesystem::path& plan, SpaceProblem problem);

/// The folder for the results of a run that begins with a plan: the one that --out gives or, without it, the default
/// folder with a suffix, so often that it is not the plan's.
/// @param usual the default folder   @param plan its file   @throws UsageError if the given folder holds the plan
/// itself
[[nodiscard]] std::filesystem::path folder_beside_plan(const std::optional<std::string>& out,
                                                       const std::filesystem::path& usual, const std::string& suffix,
                                                       const std::filesystem::path& plan);

}  // namespace downwash::cli
