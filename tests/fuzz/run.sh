#!/usr/bin/env bash
# Runs the fuzzers of the file readers, one after the other, each for so many seconds with bounded memory.
# Usage: tests/fuzz/run.sh BUILD_DIR [SECONDS (60)] [NAME...]
# What a fuzzer learns is kept in BUILD_DIR/corpus/NAME; an input that breaks a reader is left in BUILD_DIR/found.
set -euo pipefail

build=$(realpath "${1:?Usage: tests/fuzz/run.sh BUILD_DIR [SECONDS] [NAME...]}")
seconds=${2:-60}
cd -P "$(dirname "${BASH_SOURCE[0]}")"

names=("${@:3}")
if [[ ${#names[@]} -eq 0 ]]; then
    mapfile -t names < <(find "$build/fuzzers" -name 'fuzz_*' -type f -executable -printf '%f\n' | sed 's/^fuzz_//' | LC_ALL=C sort)
fi
[[ ${#names[@]} -gt 0 ]] || { echo "run.sh: there are no fuzzers in $build" >&2; exit 2; }

failed=()
for name in "${names[@]}"; do
    corpus=$build/corpus/$name
    log=$build/found/$name.log
    dictionary=()
    [[ -f dictionaries/$name.dict ]] && dictionary=("-dict=dictionaries/$name.dict")
    mkdir -p "$corpus" "$build/found"
    if UBSAN_OPTIONS=print_stacktrace=1 "$build/fuzzers/fuzz_$name" -max_total_time="$seconds" -timeout=20 \
        -rss_limit_mb=2048 -max_len=65536 -verbosity=0 -print_final_stats=1 -artifact_prefix="$build/found/$name-" "${dictionary[@]}" \
        "$corpus" "seeds/$name" >"$log" 2>&1; then
        printf '%s: nothing found in %d s, %s inputs\n' "$name" "$seconds" \
            "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")"
    else
        tail -n 60 "$log"
        printf '%s: FAILED, see %s and the input beside it\n' "$name" "$log"
        failed+=("$name")
    fi
done
[[ ${#failed[@]} -eq 0 ]] || exit 1
