#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <optional>

#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/cli/bench_commands.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/report/campaign_page.hpp"

namespace downwash::cli {
namespace {

std::string text_of_report(const bench::CampaignReport& report, const BenchReportArguments& as) {
    if (as.as_html) {
        return campaign_page(bench::page_json_of(report));
    }
    return as.as_json    ? bench::json_of(report) + "\n"
           : as.as_latex ? bench::latex_of(report)
           : as.as_csv   ? bench::csv_of(report)
                         : bench::markdown_of(report);
}

}  // namespace

ExitCode report_campaign(const BenchReportArguments& given) {
    if (given.as_html) {
        require_pages();
    }
    const bench::CampaignReport report = bench::read_report(given.folder);
    const std::string text = text_of_report(report, given);
    if (given.out) {
        write_result(*given.out, text);
    } else {
        fmt::print("{}", text);
    }
    return report.meets_its_targets() ? ExitCode::done : ExitCode::no_solution;
}

}  // namespace downwash::cli
