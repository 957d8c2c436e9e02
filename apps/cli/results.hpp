#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "downwash/cli/exit_code.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/problems/located_error.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::cli {

/// Where results go unless --out says otherwise: downwash-out/NAME-VARIANT-SEED.
[[nodiscard]] std::filesystem::path default_folder(const std::string& name, const PlannerSettings& planner);
[[nodiscard]] std::filesystem::path default_folder(const Problem& problem);

/// A length for people: "0.125 m".
[[nodiscard]] std::string millimetres(double length_m);

/// The last rows of a summary: which files there are, the page, and what else is in the folder. @param names of the
/// files
[[nodiscard]] std::string file_rows(const std::filesystem::path& folder, const std::string& names);

/// Rows about a plan that takes over from an earlier one. @param place of the vehicle at its start
/// @param has_worlds whether the problem has an uncertainty   @param unit of costs
[[nodiscard]] std::string takeover_rows(const Replanned& from, const std::string& place, bool has_worlds,
                                        std::string_view unit);

/// The obstacles that stopped most edges and how many, the first ones first: "pier 15800, bay 93".
[[nodiscard]] std::string most_stopping(const std::map<std::string, std::uint64_t>& stopped_by);

/// How a flight ended, in one sentence.
[[nodiscard]] std::string verdict_on_flight(const Execution& flight);

/// The same by an outcome. @param ok what a good flight does   @param aero whether surfaces acted on the rotors
[[nodiscard]] std::string verdict_on_outcome(Outcome outcome, bool aero, const std::string& ok);

/// What to warn of a flight through space of a scan that no sensor saw; nothing if it stays out of it.
/// @param problem file that the warning names
[[nodiscard]] std::optional<LocatedError> unseen_warning(const Solution& solution, const std::string& problem);

/// A solution for people: the verdict, then a table.
[[nodiscard]] std::string summary_of(const std::string& verdict, const Problem& problem, const Solution& solution,
                                     const std::filesystem::path& folder);

/// The exit code that a solution deserves if no signal ended the search.
[[nodiscard]] ExitCode exit_code_of(const Solution& solution);

}  // namespace downwash::cli
