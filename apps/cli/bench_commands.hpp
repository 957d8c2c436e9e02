#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

/// What `bench run` is asked for.
struct BenchRunArguments {
    std::string campaign;
    std::optional<std::string> out, shard, pilot, saved;
    std::optional<std::uint64_t> jobs;
    std::optional<double> wall_limit_s;
    bool resumes = false, no_cache = false, is_quiet = false;
};

/// What `bench merge` is asked for.
struct BenchMergeArguments {
    std::string out;
    std::vector<std::string> shards;
    bool replaces = false;
};

/// What `bench report` is asked for.
struct BenchReportArguments {
    std::string folder;
    bool as_json = false, as_html = false, as_latex = false, as_csv = false;
    std::optional<std::string> out;
};

/// What `bench slurm` and `bench parallel` are asked for.
struct BenchScriptArguments {
    std::string campaign;
    std::optional<std::string> out, pilot;
    std::uint64_t shards = 0;
    std::uint64_t task_minutes = 60;
    std::optional<std::uint64_t> jobs;
};

/// What the commands do; empty in a program that leaves them to downwash-bench.
struct BenchCommands {
    ExitCode (*run)(const BenchRunArguments&) = nullptr;
    ExitCode (*slurm)(const BenchScriptArguments&) = nullptr;
    ExitCode (*parallel)(const BenchScriptArguments&) = nullptr;
    ExitCode (*merge)(const BenchMergeArguments&) = nullptr;
    ExitCode (*report)(const BenchReportArguments&) = nullptr;
};

/// Adds `bench` and the commands below it.
void add_bench(Command program, Action& action, const BenchCommands& commands);

// The commands of downwash-bench.
ExitCode run_campaign(const BenchRunArguments& given);
ExitCode write_slurm_scripts(const BenchScriptArguments& given);
ExitCode write_parallel_scripts(const BenchScriptArguments& given);
ExitCode merge_shards(const BenchMergeArguments& given);
ExitCode report_campaign(const BenchReportArguments& given);

}  // namespace downwash::cli
