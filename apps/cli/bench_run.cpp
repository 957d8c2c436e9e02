#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>

#include "downwash/base/text.hpp"
#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_run.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/cli/bench_commands.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/report/campaign_page.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {
namespace {

/// The part of a campaign that --shard and --pilot ask for; empty: all of it. @throws UsageError
std::optional<bench::ShardRequest> shard_of(const BenchRunArguments& given) {
    if (!given.shard) {
        if (given.pilot) {
            throw UsageError("--pilot deals out shards: expected --shard I/N beside it");
        }
        return std::nullopt;
    }
    const std::size_t slash = given.shard->find('/');
    const auto number = parse_number<std::uint64_t>(given.shard->substr(0, slash));
    const auto count =
        parse_number<std::uint64_t>(slash != std::string::npos ? given.shard->substr(slash + 1) : std::string());
    if (!number || !count || *number < 1 || *number > *count || *count > bench::max_shards) {
        throw UsageError("--shard is '{}': expected I/N, for example 3/16, with 1 <= I <= N <= {}",
                         excerpt(*given.shard), bench::max_shards);
    }
    return bench::ShardRequest{*number, *count, given.pilot.value_or("")};
}

/// The folder of the results: that of a shard stands in the folder of its campaign.
std::filesystem::path out_of(const BenchRunArguments& given, const std::string& campaign,
                             const std::optional<bench::ShardRequest>& shard) {
    if (given.out) {
        return *given.out;
    }
    const std::filesystem::path folder = "downwash-out/bench-" + campaign;
    return shard ? folder / bench::shard_folder_name(shard->number, shard->count) : folder;
}

}  // namespace

ExitCode run_campaign(const BenchRunArguments& given) {
    const std::optional<bench::ShardRequest> shard = shard_of(given);
    Interruption interruption({given.wall_limit_s, {}});
    interruption.expect_results();
    ReadCampaign read = read_campaign(given.campaign, given.is_quiet ? nullptr : print_outdated,
                                      given.is_quiet ? nullptr : print_warning, space_planning_errors);
    if (given.jobs) {
        read.campaign.jobs = *given.jobs;
    }
    bench::CampaignRunOptions options;
    options.out = out_of(given, read.campaign.name, shard);
    options.shard = shard;
    options.saved = given.saved.value_or("");
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
    const bool has_page = has_pages() && progress.done > 0 && !shard;
    if (has_page) {
        write_result(options.out / "report.html", campaign_page(bench::page_json_of(bench::read_report(options.out))));
    }
    fmt::print("{} of {} runs are in {}{}; {}\n", progress.done, progress.planned, options.out.string(),
               has_page ? ", report.html shows them" : "",
               !is_over ? "--resume continues with the others"
               : shard  ? "downwash bench merge joins all shards"
                        : "see downwash bench report " + options.out.string());
    if (progress.out_of_memory > 0) {
        print_error(
            fmt::format("downwash: {} of the runs found no memory and are not finished: --resume repeats them; fewer "
                        "--jobs need less\n",
                        progress.out_of_memory));
        return ExitCode::bad_input;
    }
    const bool is_late = !is_over && interruption.code() == ExitCode::done;
    return is_late ? ExitCode::no_solution : is_over ? ExitCode::done : interruption.code();
}

}  // namespace downwash::cli
