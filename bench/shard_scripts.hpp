#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace downwash::bench {

/// A campaign in shards, for other programs to start.
struct ShardScripts {
    std::string campaign;           ///< its name
    std::filesystem::path program;  ///< this program, absolute
    std::filesystem::path file;     ///< the campaign's file, absolute
    std::filesystem::path folder;   ///< for scripts, logs and results, absolute; every node sees it
    std::filesystem::path pilot;    ///< absolute; empty: none. See ShardRequest
    std::uint64_t shards = 1;
    std::uint64_t jobs = 1;           ///< searches at a time in a shard
    std::uint64_t task_minutes = 60;  ///< Slurm's time limit of a task
    std::uint64_t at_once = 1;        ///< shards that GNU parallel runs at a time
};

/// Names and contents of scripts.
using Scripts = std::vector<std::pair<std::string, std::string>>;

/// How long the searches of a task go on [s]: up to a minute before Slurm ends it, or half of its time.
[[nodiscard]] std::uint64_t wall_limit_s(std::uint64_t task_minutes) noexcept;

/// Scripts for Slurm: submit.sh starts shard.sbatch as an array, and merge.sbatch when all tasks have ended.
/// @pre paths need no quotes in a shell or after #SBATCH
[[nodiscard]] Scripts slurm_scripts(const ShardScripts& of);

/// Scripts for GNU parallel: run.sh. @pre as for slurm_scripts()
[[nodiscard]] Scripts parallel_scripts(const ShardScripts& of);

}  // namespace downwash::bench
