#pragma once

#include <filesystem>

#include "downwash/problems/problem.hpp"

namespace downwash::cli {

/// Whether a plan was made for a problem other than `problem`; planner settings do not count. Where the file has no run
/// folder beside it, settings do count, as only their common checksum is known. A plan written by hand names no
/// problem; if its file has a certificate, that counts as another problem's.
[[nodiscard]] bool is_of_another_problem(const std::filesystem::path& plan, bool has_certificate, Problem problem);

}  // namespace downwash::cli
