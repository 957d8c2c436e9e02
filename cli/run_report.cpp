#include "downwash/cli/run_report.hpp"

#include <utility>

#include "downwash/planner/solve.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {

ShownRun shown_run(const std::filesystem::path& folder, int threads, std::shared_ptr<const AeroMap> map,
                   const std::filesystem::path& cache) {
    ShownRun run{read_run(folder), nullptr, std::move(map)};
    const Problem& problem = run.record.problem;
    run.model = make_flight_model(problem);
    if (run.map == nullptr && problem.aero.enabled) {
        run.map = run.model->make_map(problem.bounds, threads, {}, cache);
    }
    return run;
}

std::string page_of(const ShownRun& run) {
    return run_page(run.record, *run.model, run.map.get());
}

}  // namespace downwash::cli
