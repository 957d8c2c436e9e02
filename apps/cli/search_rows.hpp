#pragma once

#include <filesystem>
#include <string>

#include "downwash/planner/solution.hpp"
#include "downwash/planner/space_solve.hpp"

// What the summaries of a search in the plane and of one in space have in common.

namespace downwash::cli {

/// The result of a search, in one sentence. @param aero whether surfaces acted on the rotors of its flight
[[nodiscard]] std::string verdict_on_search(const Solution& solution, bool aero);
[[nodiscard]] std::string verdict_on_search(const SpaceSearchResult& solution, bool aero);

/// Rows about the worlds and the stops of a plan, about how the search for it went, and about what kept it from its
/// goal. @param folder of the run
[[nodiscard]] std::string search_rows(const Solution& solution, const std::filesystem::path& folder);
[[nodiscard]] std::string search_rows(const SpaceSearchResult& solution, const std::filesystem::path& folder);

}  // namespace downwash::cli
