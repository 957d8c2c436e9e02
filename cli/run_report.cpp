#include "downwash/cli/run_report.hpp"

#include <fmt/core.h>

#include <stdexcept>

#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {
namespace {

constexpr char page_name[] = "report.html";

}  // namespace

void require_pages() {
    if (!has_pages()) {
        throw UsageError(
            "this build contains no pages: install the packages that viewer/README.md names (./dev setup does), and "
            "build again");
    }
}

void write_page(const OutputFolder& folder, const RunRecord& record, int threads) {
    if (!has_pages()) {
        return;
    }
    try {
        folder.write(page_name, run_page(record, *make_flight_model(record.problem), threads));
    } catch (const std::runtime_error& error) {
        remove_page(folder);
        print_error(fmt::format("downwash: the results are written, but no {}: {}\n", page_name, error.what()));
    }
}

void remove_page(const OutputFolder& folder) {
    std::error_code ignored;
    std::filesystem::remove(folder.path() / page_name, ignored);
}

}  // namespace downwash::cli
