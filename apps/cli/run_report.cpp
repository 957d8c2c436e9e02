#include "downwash/cli/run_report.hpp"

#include <fmt/core.h>

#include <stdexcept>

#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {

void require_pages() {
    if (!has_pages()) {
        throw UsageError(
            "this build contains no pages: install the packages that apps/viewer/README.md names (./dev setup does), "
            "and "
            "build again");
    }
}

void write_page(const std::filesystem::path& folder, const RunRecord& record, int threads) {
    if (!has_pages()) {
        return;
    }
    try {
        write_made_from(source_of(folder, record), folder,
                        {{run_page_name, run_page(record, *make_flight_model(record.problem), threads)}});
    } catch (const std::runtime_error& error) {
        print_error(fmt::format("downwash: the results are written, but no {}: {}\n", run_page_name, error.what()));
    }
}

}  // namespace downwash::cli
