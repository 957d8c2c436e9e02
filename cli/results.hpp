#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "downwash/cli/exit_code.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::cli {

/// Where results go unless --out says otherwise: downwash-out/NAME-VARIANT-SEED.
[[nodiscard]] std::filesystem::path default_folder(const Problem& problem);

/// Writes effective.yaml, trajectory.csv, tree.csv and solution.json, which replace the run of before.
/// @param problem_file as the user gave it   @param warnings of reading it
/// @return the same run, as read_run() would read it from the folder
RunRecord write_results(RunFolder& folder, const Problem& problem, const std::string& problem_file,
                        const std::vector<LocatedError>& warnings, const Solution& solution);

/// The result of a search, in one sentence.
[[nodiscard]] std::string verdict_on_search(const Solution& solution);

/// How a flight ended, in one sentence.
[[nodiscard]] std::string verdict_on_flight(const Execution& flight);

/// A solution for people: the verdict, then a table.
[[nodiscard]] std::string summary_of(const std::string& verdict, const Problem& problem, const Solution& solution,
                                     const std::filesystem::path& folder);

/// The exit code that a solution deserves if no signal ended the search.
[[nodiscard]] ExitCode exit_code_of(const Solution& solution);

}  // namespace downwash::cli
