#include <fmt/core.h>

#include <filesystem>
#include <optional>

#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_run.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/report/campaign_page.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {
namespace {

struct BenchRunArguments {
    std::string campaign;
    std::optional<std::string> out;
    std::optional<std::uint64_t> jobs;
    bool resumes = false, no_cache = false, is_quiet = false;
};

ExitCode run(const BenchRunArguments& given) {
    Interruption interruption;
    interruption.expect_results();
    ReadCampaign read = read_campaign(given.campaign, given.is_quiet ? nullptr : print_outdated,
                                      given.is_quiet ? nullptr : print_warning);
    if (given.jobs) {
        read.campaign.jobs = *given.jobs;
    }
    bench::CampaignRunOptions options;
    options.out = given.out.value_or("downwash-out/bench-" + read.campaign.name);
    options.resumes = given.resumes;
    options.map_cache = cache_folder(given.no_cache);
    options.stop = interruption.token();
    bench::CampaignProgress progress;
    {
        ProgressDisplay display(given.is_quiet);
        display.say(fmt::format("{}: writing results to {}", read.campaign.name, options.out.string()));
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
               is_over ? "see downwash bench report " + options.out.string() : "--resume continues with the others");
    if (progress.out_of_memory > 0) {
        print_error(
            fmt::format("downwash: {} of the runs found no memory and are not finished: --resume repeats them; fewer "
                        "--jobs need less\n",
                        progress.out_of_memory));
        return ExitCode::bad_input;
    }
    return is_over ? ExitCode::done : interruption.code();
}

}  // namespace

void add_bench_run(CLI::App& bench, Action& action) {
    auto [command, given] = add_command(
        bench, action, "run",
        "Run problems x variants x algorithms x seeds on all processors into one SQLite file, campaign.db", run);
    command.add_option("CAMPAIGN", given.campaign, "campaign file")->required();
    add_out(command, "DIR", given.out, "folder for the results; default downwash-out/bench-NAME/");
    command.add_flag("--resume", given.resumes,
                     "continue with the results that are there, if they were begun with the same settings");
    add_jobs(command, given.jobs, "that of the campaign, or one per processor");
    add_no_cache(command, given.no_cache);
    add_quiet(command, given.is_quiet);
}

}  // namespace downwash::cli
