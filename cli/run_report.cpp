#include "downwash/cli/run_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>
#include <thread>
#include <utility>

#include "downwash/cli/progress.hpp"
#include "downwash/cli/standard_error.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {

ShownRun shown_run(const std::filesystem::path& folder, std::shared_ptr<const AeroMap> map,
                   const std::filesystem::path& cache, bool is_quiet) {
    ShownRun run{read_run(folder), nullptr, std::move(map)};
    const Problem& problem = run.record.problem;
    run.model = make_flight_model(problem);
    if (run.map == nullptr && problem.aero.enabled) {
        const int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
        ProgressDisplay display(is_quiet);
        run.map = run.model->make_map(
            problem.bounds, threads, [&display](double share) { display.show("aero map", share); }, cache);
    }
    return run;
}

void require_pages() {
    if (!has_pages()) {
        throw UsageError(
            "this build brings no pages: install what viewer/README.md names (./dev setup does), and build again");
    }
}

std::string page_of(const ShownRun& run) {
    return run_page(run.record, *run.model, run.map.get());
}

void write_page(const OutputFolder& folder, std::shared_ptr<const AeroMap> map, const std::filesystem::path& cache,
                bool is_quiet) {
    if (!has_pages()) {
        return;
    }
    constexpr char name[] = "report.html";
    try {
        folder.write(name, page_of(shown_run(folder.path(), std::move(map), cache, is_quiet)));
    } catch (const std::runtime_error& error) {
        std::error_code ignored;
        std::filesystem::remove(folder.path() / name, ignored);
        print_error(fmt::format("downwash: the results are written, but no {}: {}\n", name, error.what()));
    }
}

}  // namespace downwash::cli
