#include "downwash/cli/bench_commands.hpp"

#include "downwash/bench/campaign_shards.hpp"
#include "downwash/cli/common_options.hpp"

namespace downwash::cli {
namespace {

void add_bench_run(Command bench, Action& action, ExitCode (*run)(const BenchRunArguments&)) {
    auto [command, given] = add_command(
        bench, action, "run",
        "Run problems x variants x algorithms x seeds on all processors into one SQLite file, campaign.db", run);
    command.add_option("CAMPAIGN", given.campaign, "campaign file").required().offers_files({".yaml", ".yml"});
    add_out(command, "DIR", given.out, "folder for the results; default downwash-out/bench-NAME/");
    command.add_flag("--resume", given.resumes,
                     "continue with the results that are there, if they were begun with the same settings");
    add_jobs(command, given.jobs, "that of the campaign, or one per processor, in a shard one");
    command.add_option(
        "--shard I/N", given.shard,
        "make only the runs of shard I of N; `bench merge` joins the shards. A shard may run on any machine");
    add_pilot(command, given.pilot, "with --shard, and the same for all shards");
    command.add_option(
        "--save DIR", given.saved,
        "keep a copy of the results there, every two minutes and at the end, and begin with it if it has more "
        "runs: for results on the disk of one node");
    add_wall_limit(command, given.wall_limit_s,
                   "then searches that have not ended are dropped, the exit code is 1, and --resume continues");
    add_no_cache(command, given.no_cache);
    add_quiet(command, given.is_quiet);
}

void add_bench_merge(Command bench, Action& action, ExitCode (*run)(const BenchMergeArguments&)) {
    auto [command, given] = add_command(
        bench, action, "merge",
        "Join the shards of a campaign into one folder; exit code 1 if runs are missing, which it then names", run);
    command.add_option("OUT", given.out, "folder for the merged results").required();
    command
        .add_option("SHARD", given.shards,
                    "folders that `bench run --shard` wrote to; `-`: standard input names them, one in each line")
        .required();
    command.add_flag("--force", given.replaces, "replace what is in the folder");
}

void add_bench_report(Command bench, Action& action, ExitCode (*run)(const BenchReportArguments&)) {
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

void add_script_options(Command command, BenchScriptArguments& given) {
    command.add_option("CAMPAIGN", given.campaign, "campaign file").required().offers_files({".yaml", ".yml"});
    command.add_option("--shards N", given.shards, "how many shards")
        .required()
        .in_range(std::uint64_t{1}, bench::max_shards);
    add_out(command, "DIR", given.out,
            "folder for the scripts, the shards and their merge; default downwash-out/bench-NAME/");
    add_jobs(command, given.jobs, "that of the campaign, or one");
    add_pilot(command, given.pilot, "");
}

void add_bench_slurm(Command bench, Action& action, ExitCode (*run)(const BenchScriptArguments&)) {
    auto [command, given] =
        add_command(bench, action, "slurm",
                    "Write scripts that run a campaign in shards on a cluster with Slurm; prints the "
                    "command that submits them",
                    run);
    add_script_options(command, given);
    constexpr std::uint64_t max_minutes = 60 * 24 * 30;
    command
        .add_option("--task-time MIN", given.task_minutes,
                    "Slurm's time limit of a task [min]: before it is over the task keeps what is finished and goes "
                    "back to the "
                    "queue; default 60")
        .in_range(std::uint64_t{1}, max_minutes);
}

void add_bench_parallel(Command bench, Action& action, ExitCode (*run)(const BenchScriptArguments&)) {
    auto [command, given] = add_command(bench, action, "parallel",
                                        "Write scripts that run a campaign in shards on one machine with GNU parallel; "
                                        "prints the command that starts them",
                                        run);
    add_script_options(command, given);
}

}  // namespace

void add_bench(Command program, Action& action, const BenchCommands& commands) {
    Command bench = program.add_command("bench", "Run campaigns: many searches, their success, times and costs");
    bench.require_command();
    add_bench_run(bench, action, commands.run);
    add_bench_slurm(bench, action, commands.slurm);
    add_bench_parallel(bench, action, commands.parallel);
    add_bench_merge(bench, action, commands.merge);
    add_bench_report(bench, action, commands.report);
}

}  // namespace downwash::cli
