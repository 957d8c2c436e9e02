#include "downwash/cli/run_report.hpp"

#include <fmt/core.h>

#include <functional>
#include <stdexcept>
#include <string>

#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/report/run_page.hpp"
#include "downwash/report/space_page.hpp"

namespace downwash::cli {

void require_pages() {
    if (!has_pages()) {
        throw UsageError(
            "this build contains no pages: install the packages that apps/viewer/README.md names (./dev setup does), "
            "and "
            "build again");
    }
}

namespace {

/// @param made the page
void write_made(const std::filesystem::path& folder, const std::string& solution_text,
                const std::function<std::string()>& made) {
    if (!has_pages()) {
        return;
    }
    try {
        write_made_from(source_of(folder, solution_text), folder, {{run_page_name, made()}});
    } catch (const std::runtime_error& error) {
        print_error(fmt::format("downwash: the results are written, but no {}: {}\n", run_page_name, error.what()));
    }
}

}  // namespace

void write_page(const std::filesystem::path& folder, const RunRecord& record, int threads) {
    write_made(folder, record.solution_text,
               [&] { return run_page(record, *make_flight_model(record.problem), threads); });
}

void write_page(const std::filesystem::path& folder, const SpaceRunRecord& record) {
    write_made(folder, record.solution_text, [&] { return space_page(record.problem, shown_run(record)); });
}

}  // namespace downwash::cli
