#pragma once

#include <optional>
#include <string>

#include "downwash/base/export.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash {

/// What the page of a problem in space shows beside the problem.
struct SpaceRun {
    /// One row per control tick with the columns of trajectory.csv in space, from t_s on; a clearance without obstacles
    /// is NaN. No rows: nothing was flown.
    NumberTable flight = {};
    std::string solution_text = {};        ///< solution.json; empty: the problem is not planned
    std::string problem_text = {};         ///< effective.yaml; empty: the page does not show it
    std::string findings = {};             ///< JSON that `validate --json` prints; empty: nothing was judged
    std::string command = {};              ///< that makes the files again; empty: none
    std::string warnings = {};             ///< JSON list of what reading the problem warned of, as in solution.json
    std::optional<VisitOrder> order = {};  ///< of the targets; empty: none, or the plan shows it
};

/// A run in space as its page shows it: with its warnings, and the command that makes its files again.
[[nodiscard]] DOWNWASH_EXPORT SpaceRun shown_run(const SpaceRunRecord& record);

/// A problem in space as one self-contained HTML file, with its flight where there is one: three-dimensional view with
/// playback, plots over time, tables of facts, and what a judge found. The numbers of the flight equal those of the
/// table to the last bit. Equal inputs give equal bytes.
/// @pre space_problem_errors(problem) is empty; the texts are what they are said to be; has_pages() (run_page.hpp)
[[nodiscard]] DOWNWASH_EXPORT std::string space_page(const SpaceProblem& problem, const SpaceRun& run = {});

/// The data within that page, as JSON (`downwash/space-report/v1`).
[[nodiscard]] DOWNWASH_EXPORT std::string space_page_data(const SpaceProblem& problem, const SpaceRun& run = {});

}  // namespace downwash
