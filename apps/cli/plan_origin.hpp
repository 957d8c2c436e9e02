#pragma once

#include <filesystem>

#include "downwash/problems/problem.hpp"

namespace downwash::cli {

/// Whether a plan was made for another problem than that in which it is flown; planner settings do not count. A file
/// without its run may be of the same problem with other settings, which nobody can tell. A plan written by hand is of
/// no problem, so a certificate in its file is of another one.
[[nodiscard]] bool is_of_another_problem(const std::filesystem::path& plan, bool has_certificate, Problem problem);

}  // namespace downwash::cli
