#include "downwash/bench/shard_scripts.hpp"

#include <algorithm>
#include <string_view>

#include "downwash/base/sha256.hpp"

namespace downwash::bench {
namespace {

constexpr std::string_view shard_script = R"sh(#!/usr/bin/env bash
# Runs shard I of the campaign @CAMPAIGN@: shard.sh I. Start it as often as you like: it goes on where it was.
# Exit code 0: the shard is complete; 1: its time is over, start it again; 75: it is running already on this machine;
# others: an error, which is on standard error.
set -uo pipefail

shard=${1:?expected a number: shard.sh I}
shards=@SHARDS@
kept=@FOLDER@/shards/$(printf 'shard-%0@DIGITS@d-of-%0@DIGITS@d' "$shard" "$shards")
@SCRATCH@
mkdir -p "$kept" || exit 2

# Forwards a signal to the program, which then keeps what is finished.
child=
trap '[[ -z $child ]] || kill -TERM "$child"' TERM INT

run() {
    @PROGRAM@ bench run @FILE@ --shard "$shard/$shards"@PILOT@ --jobs @JOBS@ --resume --quiet@LIMIT@ "$@" &
    child=$!
    local code=0
    wait "$child" || code=$?
    if ((code > 128)) && kill -0 "$child" 2>/dev/null; then # the signal has ended `wait`, not yet the program
        code=0
        wait "$child" || code=$?
    fi
    return "$code"
}

@RUN@
)sh";

/// Results on the disk of the node, and a copy on the disk that all nodes see.
constexpr std::string_view scratch_setup =
    R"sh(limit_s=@WALL_LIMIT_S@ # then what is finished is kept, before Slurm ends the task
scratch=${DOWNWASH_SCRATCH:-${SLURM_TMPDIR:-${TMPDIR:-/tmp}}}/downwash-$(id -u)-@DIGEST@
here=$scratch/$(basename "$kept")

# Nobody else may have made the folder, as in /tmp.
own_scratch() { mkdir -p -m 700 "$scratch" 2>/dev/null && [[ -O $scratch && ! -L $scratch ]]; }

# Whether 4 MB can still be written there.
scratch_has_room() {
    head -c 4000000 /dev/zero 2>/dev/null >"$here.probe"
    local code=$?
    rm -f "$here.probe"
    return "$code"
})sh";

constexpr std::string_view scratch_run = R"sh(code=2
if own_scratch && exec 9>>"$here.lock"; then
    flock --nonblock 9 || { echo "shard $shard is running on this machine already" >&2; exit 75; }
    run --out "$here" --save "$kept"
    code=$?
    # The copy has everything then; the lock goes with the last program that holds it.
    ((code != 0)) || rm -rf "$here" "$here.lock"
fi
if ((code == 2)) && ! { own_scratch && scratch_has_room; }; then
    echo "shard $shard: $scratch cannot be used on $(hostname), going on in $kept" >&2
    run --out "$kept"
    code=$?
fi
exit "$code")sh";

/// What is left of the task's time for the program.
constexpr std::string_view time_limit = " --wall-limit $((SECONDS + 1 < limit_s ? limit_s - SECONDS : 1))";

constexpr std::string_view shard_batch = R"sh(#!/usr/bin/env bash
#SBATCH --job-name=downwash-@CAMPAIGN@
#SBATCH --output=@FOLDER@/logs/shards-%A_%a.log
#SBATCH --open-mode=append
#SBATCH --cpus-per-task=@JOBS@
#SBATCH --time=@MINUTES@
#SBATCH --requeue
# One task of an array: submit.sh submits it, with the number of shards before those of the array. A task whose time is
# over puts itself into the queue again.
set -uo pipefail

shard=$((SLURM_ARRAY_TASK_ID + ${1:-0}))
restarts=${SLURM_RESTART_COUNT:-0}
child=
told=
trap 'told=1; [[ -z $child ]] || kill -TERM "$child"' TERM
bash @FOLDER@/shard.sh "$shard" &
child=$!
code=0
wait "$child" || code=$?
if ((code > 128)) && kill -0 "$child" 2>/dev/null; then # the signal has ended `wait`, not yet the shard
    code=0
    wait "$child" || code=$?
fi
task=${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID
if [[ -n $told ]]; then # by scancel, if not for its time
    job=$(scontrol show job "$task" 2>/dev/null)
    [[ $job != *JobState=* || $job == *Reason=TimeLimit* ]] || exit "$code"
fi
case $code in
    0) exit 0 ;;
    1) most=1000 ;; # its time is over
    75) exit 75 ;;
    *) most=5 ;; # killed, out of memory, a disk that fails: perhaps not on another node
esac
if ((restarts < most)); then
    echo "shard $shard ended with $code: it is put into the queue again" >&2
    for ((try = 0; try < 20; ++try)); do # the controller may be away
        scontrol requeue "$task" && exit 0
        sleep 15
    done
fi
exit "$code"
)sh";

constexpr std::string_view merge_script = R"sh(#!/usr/bin/env bash
# Merges the shards that there are into @FOLDER@/merged. Exit code 1 if runs are missing: it names
# them and the commands that make them.
set -euo pipefail

for file in @FOLDER@/shards/shard-*-of-@COUNT@/campaign.db; do
    [[ ! -e $file ]] || echo "${file%/*}"
done | @PROGRAM@ bench merge @FOLDER@/merged --force -
)sh";

constexpr std::string_view merge_batch = R"sh(#!/usr/bin/env bash
#SBATCH --job-name=downwash-@CAMPAIGN@-merge
#SBATCH --output=@FOLDER@/logs/merge-%j.log
#SBATCH --time=@MERGE_MINUTES@
#SBATCH --requeue
exec bash @FOLDER@/merge.sh
)sh";

constexpr std::string_view submit_script = R"sh(#!/usr/bin/env bash
# Submits all shards of the campaign @CAMPAIGN@ to Slurm, and their merge for when they have ended. Options go to sbatch:
# submit.sh --partition=short. Submit again to make what is missing: shards that are complete end at once.
set -euo pipefail

shards=@SHARDS@
# The greatest index of an array is one less than MaxArraySize.
size=$(scontrol show config | sed -n 's/^MaxArraySize *= *\([0-9]*\).*/\1/p')
size=$((${size:-1001} - 1))
mkdir -p @FOLDER@/logs
jobs=()
for ((offset = 0; offset < shards; offset += size)); do
    last=$((shards - offset < size ? shards - offset : size))
    job=$(sbatch --parsable --array="1-$last" "$@" @FOLDER@/shard.sbatch "$offset")
    jobs+=("${job%%;*}")
done
merge=$(sbatch --parsable --dependency="afterany:$(IFS=:; echo "${jobs[*]}")" "$@" @FOLDER@/merge.sbatch)
echo "submitted ${jobs[*]}; job ${merge%%;*} merges them into @FOLDER@/merged"
)sh";

constexpr std::string_view parallel_script = R"sh(#!/usr/bin/env bash
# Runs all shards of the campaign @CAMPAIGN@ on this machine with GNU parallel, and merges them. Start it again to make
# what is missing: shards that are complete end at once.
set -uo pipefail

seq 1 @SHARDS@ | parallel --jobs @AT_ONCE@ --retries 3 --joblog @FOLDER@/parallel.log bash @FOLDER@/shard.sh {}
exec bash @FOLDER@/merge.sh
)sh";

using Values = std::vector<std::pair<std::string_view, std::string>>;

/// A template with @NAMES@ replaced.
std::string filled(std::string_view from, const Values& values) {
    std::string text;
    for (std::size_t at = 0; at < from.size();) {
        const auto found = std::find_if(values.begin(), values.end(), [&](const auto& value) {
            return from[at] == '@' && from.substr(at + 1).starts_with(value.first) &&
                   from.substr(at + 1 + value.first.size()).starts_with('@');
        });
        if (found == values.end()) {
            text += from[at++];
        } else {
            text += found->second;
            at += found->first.size() + 2;
        }
    }
    return text;
}

Values values_of(const ShardScripts& of) {
    const std::size_t digits = std::max<std::size_t>(4, std::to_string(of.shards).size());
    constexpr std::uint64_t min_merge_minutes = 10, max_merge_minutes = 60;
    const std::string count = std::to_string(of.shards);
    return {{"CAMPAIGN", of.campaign},
            {"PROGRAM", of.program.string()},
            {"FILE", of.file.string()},
            {"FOLDER", of.folder.string()},
            {"PILOT", of.pilot.empty() ? "" : " --pilot " + of.pilot.string()},
            {"SHARDS", count},
            {"COUNT", std::string(digits - count.size(), '0') + count},
            {"DIGITS", std::to_string(digits)},
            {"JOBS", std::to_string(of.jobs)},
            {"MINUTES", std::to_string(of.task_minutes)},
            {"MERGE_MINUTES", std::to_string(std::clamp(of.task_minutes, min_merge_minutes, max_merge_minutes))},
            {"AT_ONCE", std::to_string(of.at_once)},
            {"WALL_LIMIT_S", std::to_string(wall_limit_s(of.task_minutes))},
            // Campaigns of one name in different folders do not share a scratch folder.
            {"DIGEST", sha256_hex(of.folder.string()).substr(0, 12)}};
}

}  // namespace

std::uint64_t wall_limit_s(std::uint64_t task_minutes) noexcept {
    constexpr std::uint64_t reserve_s = 60;  // to keep what is finished
    const std::uint64_t task_s = 60 * task_minutes;
    return task_s - std::min(reserve_s, task_s / 2);
}

Scripts slurm_scripts(const ShardScripts& of) {
    Values values = values_of(of);
    values.emplace_back("SCRATCH", filled(scratch_setup, values));
    values.emplace_back("LIMIT", time_limit);
    values.emplace_back("RUN", scratch_run);
    return {{"shard.sh", filled(shard_script, values)},
            {"shard.sbatch", filled(shard_batch, values)},
            {"merge.sh", filled(merge_script, values)},
            {"merge.sbatch", filled(merge_batch, values)},
            {"submit.sh", filled(submit_script, values)}};
}

Scripts parallel_scripts(const ShardScripts& of) {
    Values values = values_of(of);
    values.emplace_back("SCRATCH", "");
    values.emplace_back("LIMIT", "");
    values.emplace_back("RUN", "run --out \"$kept\"");
    return {{"shard.sh", filled(shard_script, values)},
            {"merge.sh", filled(merge_script, values)},
            {"run.sh", filled(parallel_script, values)}};
}

}  // namespace downwash::bench
