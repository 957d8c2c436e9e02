#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

#include "downwash/bench/campaign_run.hpp"
#include "downwash/bench/campaign_shards.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/shard_scripts.hpp"
#include "downwash/cli/bench_commands.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/program.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/space_solve.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

/// An absolute path that needs no quotes in a script. @throws UsageError
fs::path plain_path(const fs::path& given, const std::string& what) {
    fs::path path = fs::absolute(given).lexically_normal();
    const std::string text = path.string();
    if (shell_word(text) != text || text.find('%') != std::string::npos) {
        throw UsageError(
            "{} {}: scripts for other programs hold this path, so it may have letters, digits and -_./+:@,= "
            "only",
            what, text);
    }
    return path;
}

bench::ShardScripts scripts_of(const BenchScriptArguments& given) {
    const ReadCampaign read = read_campaign(given.campaign, print_outdated, print_warning, space_planning_errors);
    const fs::path pilot = given.pilot ? plain_path(*given.pilot, "--pilot") : fs::path();
    static_cast<void>(bench::plan_of(read, bench::ShardRequest{1, given.shards, pilot}));  // it can be dealt out
    bench::ShardScripts scripts;
    scripts.campaign = read.campaign.name;
    scripts.program = plain_path(program_folder() / "downwash", "the program");
    scripts.file = plain_path(given.campaign, "the campaign");
    scripts.folder = plain_path(given.out.value_or("downwash-out/bench-" + read.campaign.name), "--out");
    scripts.pilot = pilot;
    scripts.shards = given.shards;
    scripts.jobs = given.jobs.value_or(read.campaign.jobs.value_or(1));
    scripts.task_minutes = given.task_minutes;
    scripts.at_once = std::max<std::uint64_t>(1, bench::processor_count() / scripts.jobs);
    return scripts;
}

/// Writes the scripts and says which one to start.
ExitCode write(const bench::Scripts& scripts, const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    for (const auto& [name, text] : scripts) {
        write_result(folder / name, text, "--out");
    }
    fmt::print("bash {}\n", (folder / scripts.back().first).string());
    return ExitCode::done;
}

}  // namespace

ExitCode write_slurm_scripts(const BenchScriptArguments& given) {
    const bench::ShardScripts scripts = scripts_of(given);
    const std::optional<double> search_s = read_campaign(given.campaign, nullptr, nullptr).campaign.time_limit_s;
    if (search_s && *search_s >= static_cast<double>(bench::wall_limit_s(given.task_minutes))) {
        throw UsageError(
            "--task-time is {} min, of which searches have {} s, but one of the campaign takes {} s: "
            "expected more time",
            given.task_minutes, bench::wall_limit_s(given.task_minutes), *search_s);
    }
    return write(bench::slurm_scripts(scripts), scripts.folder);
}

ExitCode write_parallel_scripts(const BenchScriptArguments& given) {
    const bench::ShardScripts scripts = scripts_of(given);
    return write(bench::parallel_scripts(scripts), scripts.folder);
}

}  // namespace downwash::cli
