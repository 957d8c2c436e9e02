#include "downwash/cli/search_results.hpp"

#include <fmt/core.h>

#include "downwash/cli/input_lines.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/search_rows.hpp"

namespace downwash::cli {

void write_search(RunFolder& folder, const PlannableProblem& plannable, const Solution& solution,
                  std::vector<LocatedError> warnings, const SearchOutput& output) {
    const Problem& problem = plannable.problem;
    if (const auto warning = unseen_warning(solution, output.problem)) {
        noting(warnings, output.is_quiet)(*warning);
    }
    const InputFacts inputs = input_facts(problem, plannable.model->scene());
    const RunRecord record = folder.write(problem, output.problem, warnings, solution, inputs);
    // In free air there is no map. Without a map and a search there is nothing to be shown yet.
    if (solution.map != nullptr || solution.planning.iterations > 0 || !solution.interrupted) {
        write_page(folder.path(), record, output.threads);
    }
    const bool is_with_aero = solution.execution && solution.execution->aero;
    fmt::print("{}", output.as_json
                         ? record.solution_text
                         : summary_of(verdict_on_search(solution, is_with_aero), problem, solution, folder.path()) +
                               input_rows(inputs));
}

}  // namespace downwash::cli
