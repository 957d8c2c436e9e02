#include <fmt/core.h>

#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/cli/commands.hpp"

namespace downwash::cli {
namespace {

struct BenchReportArguments {
    std::string folder;
    bool as_json = false;
};

ExitCode run(const BenchReportArguments& arguments) {
    const bench::CampaignReport report = bench::report_of(bench::read_results(arguments.folder));
    fmt::print("{}", arguments.as_json ? bench::json_of(report) + "\n" : bench::markdown_of(report));
    return report.keeps_its_bars() ? ExitCode::done : ExitCode::no_solution;
}

}  // namespace

void add_bench_report(CLI::App& bench, Action& action) {
    const auto arguments = std::make_shared<BenchReportArguments>();
    CLI::App* command = bench.add_subcommand(
        "report", "Say what a campaign came to, as Markdown; exit code 1 when it misses a bar that its file sets");
    command->add_option("DIR", arguments->folder, "folder that `bench run` wrote to")->required();
    command->add_flag("--json", arguments->as_json, "print the figures as JSON");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
