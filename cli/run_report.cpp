#include "downwash/cli/run_report.hpp"

#include <fmt/core.h>

#include <stdexcept>
#include <utility>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {

ShownRun shown_run(RunRecord record, std::shared_ptr<const AeroMap> map, const std::filesystem::path& cache,
                   bool is_quiet, int threads) {
    ShownRun run{std::move(record), nullptr, std::move(map)};
    run.model = make_flight_model(run.record.problem);
    if (run.map == nullptr) {
        run.map = map_for_page(run.record.problem, *run.model, cache, is_quiet, threads);
    }
    return run;
}

std::shared_ptr<const AeroMap> map_for_page(const Problem& problem, const FlightModel& model,
                                            const std::filesystem::path& cache, bool is_quiet, int threads) {
    if (!problem.aero.enabled) {
        return nullptr;
    }
    ProgressDisplay display(is_quiet);
    return model.make_map(
        problem.bounds, threads, [&display](double share) { display.show("aero map", share); }, cache);
}

void require_pages() {
    if (!has_pages()) {
        throw UsageError(
            "this build contains no pages: install the packages that viewer/README.md names (./dev setup does), and "
            "build again");
    }
}

void write_page(const std::filesystem::path& folder, const RunRecord& record, std::shared_ptr<const AeroMap> map,
                const std::filesystem::path& cache, bool is_quiet, int threads) {
    if (!has_pages()) {
        return;
    }
    try {
        const ShownRun run = shown_run(record, std::move(map), cache, is_quiet, threads);
        write_made_from(source_of(folder, record), folder,
                        {{run_page_name, run_page(run.record, *run.model, run.map.get())}});
    } catch (const std::runtime_error& error) {
        print_error(fmt::format("downwash: the results are written, but no {}: {}\n", run_page_name, error.what()));
    }
}

}  // namespace downwash::cli
