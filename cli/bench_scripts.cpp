#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

#include "downwash/bench/campaign_run.hpp"
#include "downwash/bench/campaign_shards.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/shard_scripts.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

struct ScriptArguments {
    std::string campaign;
    std::optional<std::string> out, pilot;
    std::uint64_t shards = 0;
    std::uint64_t task_minutes = 60;
    std::optional<std::uint64_t> jobs;
};

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

bench::ShardScripts scripts_of(const ScriptArguments& given) {
    const ReadCampaign read = read_campaign(given.campaign, print_outdated, print_warning);
    const fs::path pilot = given.pilot ? plain_path(*given.pilot, "--pilot") : fs::path();
    static_cast<void>(bench::plan_of(read, bench::ShardRequest{1, given.shards, pilot}));  // it can be dealt out
    bench::ShardScripts scripts;
    scripts.campaign = read.campaign.name;
    scripts.program = plain_path(fs::read_symlink("/proc/self/exe"), "the program");
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

ExitCode run_slurm(const ScriptArguments& given) {
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

ExitCode run_parallel(const ScriptArguments& given) {
    const bench::ShardScripts scripts = scripts_of(given);
    return write(bench::parallel_scripts(scripts), scripts.folder);
}

void add_script_options(Command command, ScriptArguments& given) {
    command.add_option("CAMPAIGN", given.campaign, "campaign file").required();
    command.add_option("--shards N", given.shards, "how many shards")
        .required()
        .in_range(std::uint64_t{1}, bench::max_shards);
    add_out(command, "DIR", given.out,
            "folder for the scripts, the shards and their merge; default downwash-out/bench-NAME/");
    add_jobs(command, given.jobs, "that of the campaign, or one");
    add_pilot(command, given.pilot, "");
}

}  // namespace

void add_bench_slurm(Command bench, Action& action) {
    auto [command, given] =
        add_command(bench, action, "slurm",
                    "Write scripts that run a campaign in shards on a cluster with Slurm; prints the "
                    "command that submits them",
                    run_slurm);
    add_script_options(command, given);
    constexpr std::uint64_t max_minutes = 60 * 24 * 30;
    command
        .add_option("--task-time MIN", given.task_minutes,
                    "Slurm's time limit of a task [min]: before it is over the task keeps what is finished and goes "
                    "back to the "
                    "queue; default 60")
        .in_range(std::uint64_t{1}, max_minutes);
}

void add_bench_parallel(Command bench, Action& action) {
    auto [command, given] = add_command(bench, action, "parallel",
                                        "Write scripts that run a campaign in shards on one machine with GNU parallel; "
                                        "prints the command that starts them",
                                        run_parallel);
    add_script_options(command, given);
}

}  // namespace downwash::cli
