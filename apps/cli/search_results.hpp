#pragma once

#include <string>
#include <vector>

#include "downwash/planner/solution.hpp"
#include "downwash/problems/located_error.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/results/run_folder.hpp"

namespace downwash::cli {

/// How a command that searches tells what came of it.
struct SearchOutput {
    std::string problem;  ///< its file
    int threads = 1;      ///< that draw the page
    bool is_quiet = false, as_json = false;
};

/// Writes what a search found into its folder, with its page, and prints the summary or solution.json.
/// @param warnings of reading its files; those of the plan are told and added
void write_search(RunFolder& folder, const PlannableProblem& plannable, const Solution& solution,
                  std::vector<LocatedError> warnings, const SearchOutput& output);

}  // namespace downwash::cli
