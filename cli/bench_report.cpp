#include <fmt/core.h>

#include <optional>

#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/output_folder.hpp"
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
        return campaign_page(bench::json_of(report));
    }
    return as.as_json    ? bench::json_of(report) + "\n"
           : as.as_latex ? bench::latex_of(report)
           : as.as_csv   ? bench::csv_of(report)
                         : bench::markdown_of(report);
}

ExitCode run(const BenchReportArguments& arguments) {
    if (arguments.as_html) {
        require_pages();
    }
    const bench::CampaignReport report = bench::report_of(bench::read_results(arguments.folder));
    const std::string text = text_of(report, arguments);
    if (arguments.out) {
        write_result(*arguments.out, text);
    } else {
        fmt::print("{}", text);
    }
    return report.keeps_its_bars() ? ExitCode::done : ExitCode::no_solution;
}

}  // namespace

void add_bench_report(CLI::App& bench, Action& action) {
    const auto arguments = std::make_shared<BenchReportArguments>();
    CLI::App* command = bench.add_subcommand(
        "report", "Say what a campaign came to, as Markdown; exit code 1 when it misses a bar that its file sets");
    command->add_option("DIR", arguments->folder, "folder that `bench run` wrote to")->required();
    CLI::Option* json = command->add_flag("--json", arguments->as_json, "JSON: every figure, and those of every seed");
    CLI::Option* html =
        command->add_flag("--html", arguments->as_html, "one HTML page with pictures, as `bench run` writes it")
            ->excludes(json);
    CLI::Option* latex =
        command->add_flag("--latex", arguments->as_latex, "the table of a paper, for the LaTeX package booktabs")
            ->excludes(json)
            ->excludes(html);
    command->add_flag("--csv", arguments->as_csv, "CSV: a row for every problem and planner")
        ->excludes(json)
        ->excludes(html)
        ->excludes(latex);
    command->add_option("-o,--out", arguments->out, "file to write to; left out: standard output")->type_name("FILE");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
