#include <fmt/core.h>

#include <filesystem>
#include <optional>

#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_run.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/cli/cache_folder.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/output_folder.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/report/campaign_page.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {
namespace {

struct BenchRunArguments {
    std::string campaign;
    std::optional<std::string> out;
    bool resumes = false;
    bool no_cache = false;
    bool is_quiet = false;
};

ExitCode run(const BenchRunArguments& arguments) {
    const Interruption interruption;
    const ReadCampaign read = read_campaign(arguments.campaign);
    bench::CampaignRunOptions options;
    options.out = arguments.out.value_or("downwash-out/bench-" + read.campaign.name);
    options.resumes = arguments.resumes;
    options.map_cache = arguments.no_cache ? std::filesystem::path() : cache_folder();
    options.stop = interruption.token();
    bench::CampaignProgress progress;
    {
        ProgressDisplay display(arguments.is_quiet);
        display.say(fmt::format("{}: running into {}", read.campaign.name, options.out.string()));
        options.on_progress = [&](double share) { display.show(read.campaign.name, share); };
        options.on_map_progress = [&](const std::string& problem, double share) {
            display.show("aero map of " + problem, share);
        };
        progress = bench::run_campaign(read, options);
    }
    const bool is_over = progress.done == progress.planned;
    const bool has_page = has_pages() && progress.done > 0;
    if (has_page) {
        write_result(options.out / "report.html",
                     campaign_page(bench::json_of(bench::report_of(bench::read_results(options.out)))));
    }
    fmt::print("{} of {} runs are in {}{}; {}\n", progress.done, progress.planned, options.out.string(),
               has_page ? ", report.html shows them" : "",
               is_over ? "see downwash bench report " + options.out.string() : "--resume goes on with the others");
    return is_over ? ExitCode::done : interruption.code();
}

}  // namespace

void add_bench_run(CLI::App& bench, Action& action) {
    const auto arguments = std::make_shared<BenchRunArguments>();
    CLI::App* command = bench.add_subcommand(
        "run", "Run problems x variants x algorithms x seeds into one SQLite file, campaign.db, on all processors");
    command->add_option("CAMPAIGN", arguments->campaign, "campaign file")->required();
    command->add_option("--out", arguments->out, "folder of the results; default downwash-out/bench-NAME/")
        ->type_name("DIR");
    command->add_flag("--resume", arguments->resumes,
                      "go on with the results that are there, if they were begun with the same settings");
    command->add_flag("--no-cache", arguments->no_cache,
                      "neither read nor write the cache of aero maps in $XDG_CACHE_HOME/downwash (~/.cache/downwash)");
    command->add_flag("--quiet", arguments->is_quiet, "only errors on standard error, no progress");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
