#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/results/number_table.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/results/space_solution_file.hpp"

namespace downwash {

/// A finished run: what its folder holds, in memory.
struct RunRecord {
    Problem problem;                  ///< effective.yaml
    std::string problem_text;         ///< the same as text
    std::string solution_text;        ///< solution.json: well-formed, of the schema that this version writes
    std::string status;               ///< status of the solution: "solved", "approximate" or "none"
    std::string outcome;              ///< outcome of its flight: "ok", "collision"...; empty without one
    std::optional<Plan> plan;         ///< plan of the solution; empty without one
    std::optional<VisitOrder> order;  ///< order in which the plan visits targets; empty without a plan or targets
    NumberTable flight;               ///< trajectory.csv; no rows when nothing was flown
    NumberTable tree;                 ///< tree.csv: x_m, z_m, arm_rad, parent; no rows without it
};

/// The record of a run that has just ended. The texts stay empty: they are those of the files that are written.
/// @param flight of the solution, or one without rows when nothing was flown
[[nodiscard]] DOWNWASH_EXPORT RunRecord run_record(const Problem& problem, const Solution& solution,
                                                   const Execution& flight);

/// The files that a run leaves in a folder: names and contents, in the order in which they are to be written.
/// solution.json is the last: until it is there, what is in the folder is no run.
/// @param problem_file as the user gave it   @param folder in which effective.yaml will be
/// @param warnings of reading the problem   @param inputs what of it was read; empty: solution.json does not say
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::pair<std::string, std::string>> run_files(
    const Problem& problem, const std::string& problem_file, const Solution& solution, const Execution& flight,
    const std::filesystem::path& folder, const std::vector<LocatedError>& warnings = {},
    const std::optional<InputFacts>& inputs = {});

/// Reads what `solve` or `execute` left in a folder. All files have to be of the same run: solution.json holds digests
/// of the others.
/// @throws ProblemFileError or InputError with the place of every error: a file that is missing or is not what they
/// write, or the run is one in space
[[nodiscard]] DOWNWASH_EXPORT RunRecord read_run(const std::filesystem::path& folder);

/// A finished flight in space: what its folder holds, in memory.
struct SpaceRunRecord {
    SpaceProblem problem;       ///< effective.yaml
    std::string problem_text;   ///< the same as text
    std::string solution_text;  ///< solution.json
    std::string status;         ///< as of RunRecord
    std::string outcome;        ///< as of RunRecord
    std::optional<SpacePlan> plan;
    std::optional<VisitOrder> order;  ///< as of RunRecord; also empty where the plan shows it
    NumberTable flight;               ///< trajectory.csv
};

/// The record of a flight in space that has just ended; the texts stay empty.
[[nodiscard]] DOWNWASH_EXPORT SpaceRunRecord run_record(const SpaceProblem& problem, const SpaceSolution& solution);

/// The files that a flight in space leaves in a folder: see above. There is a tree.csv if a search found the plan.
/// @pre the solution has an execution
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::pair<std::string, std::string>> run_files(
    const SpaceProblem& problem, const std::string& problem_file, const SpaceSolution& solution,
    const std::filesystem::path& folder, const std::vector<LocatedError>& warnings = {},
    const std::optional<SpaceInputFacts>& inputs = {});

/// Reads what `execute` left in a folder for a problem in space: see read_run(). @throws as read_run()
[[nodiscard]] DOWNWASH_EXPORT SpaceRunRecord read_space_run(const std::filesystem::path& folder);

/// Whether a folder holds a run in space: its effective.yaml is a problem in space. False where there is none.
[[nodiscard]] DOWNWASH_EXPORT bool is_space_run(const std::filesystem::path& folder);

/// Which problem a solution.json is of, as it says. What it does not say is empty.
/// @throws InputError if there is no such file or it is not what they write
[[nodiscard]] DOWNWASH_EXPORT ProblemReference problem_of_solution(const std::filesystem::path& file);

/// Checks that the files in a folder are of the same run, as far as they are there: for those who read its
/// solution.json only. A plan that was written by hand holds no digests, and nothing is compared.
/// @throws InputError or ProblemFileError like read_run()
DOWNWASH_EXPORT void require_whole_run(const std::filesystem::path& folder);

}  // namespace downwash
