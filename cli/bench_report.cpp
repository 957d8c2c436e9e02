#include <fmt/core.h>

#include <optional>

#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/report/campaign_page.hpp"

namespace downwash::cli {
namespace {

struct BenchReportArguments {
    std::string folder;
    bool as_json = false, as_html = false, as_latex = false, as_csv = false;
    std::optional<std::string> out;
};

std::string text_of(const bench::CampaignReport& report, const BenchReportArguments& as) {
    if (as.as_html) {
        return campaign_page(bench::page_json_of(report));
    }
    return as.as_json    ? bench::json_of(report) + "\n"
           : as.as_latex ? bench::latex_of(report)
           : as.as_csv   ? bench::csv_of(report)
                         : bench::markdown_of(report);
}

ExitCode run(const BenchReportArguments& given) {
    if (given.as_html) {
        require_pages();
    }
    const bench::CampaignReport report = bench::read_report(given.folder);
    const std::string text = text_of(report, given);
    if (given.out) {
        write_result(*given.out, text);
    } else {
        fmt::print("{}", text);
    }
    return report.meets_its_targets() ? ExitCode::done : ExitCode::no_solution;
}

}  // namespace

void add_bench_report(Command bench, Action& action) {
    auto [command, given] = add_command(
        bench, action, "report",
        "Report the results of a campaign as Markdown; exit code 1 if it misses a target that its file sets", run);
    command.add_option("DIR", given.folder, "folder that `bench run` wrote to").required();
    add_json(command, given.as_json, "every figure, and those of every seed");
    Option json = command.option("--json");
    Option html = command.add_flag("--html", given.as_html, "one HTML page with pictures, as `bench run` writes it");
    Option latex = command.add_flag("--latex", given.as_latex, "a table for papers, for the LaTeX package booktabs");
    Option csv = command.add_flag("--csv", given.as_csv, "CSV: one row per problem and planner");
    html.excludes(json);
    latex.excludes(json).excludes(html);
    csv.excludes(json).excludes(html).excludes(latex);
    add_out(command, "FILE", given.out, "a file; default: standard output");
}

}  // namespace downwash::cli
