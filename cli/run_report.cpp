#include "downwash/cli/run_report.hpp"

#include <utility>

#include "downwash/planner/solve.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {

std::string page_of(const std::filesystem::path& folder, int threads, std::shared_ptr<const AeroMap> map,
                    const std::filesystem::path& cache) {
    const RunRecord run = read_run(folder);
    const auto model = make_flight_model(run.problem);
    if (map == nullptr && run.problem.aero.enabled) {
        map = model->make_map(run.problem.bounds, threads, {}, cache);
    }
    return run_page(run, *model, map.get());
}

}  // namespace downwash::cli
