#!/usr/bin/env bash
# Plans the shipped problems on this processor and, under qemu, on an emulated arm64, and compares what was flown and the
# tree byte by byte. Not MP-ARM: its planners are OMPL's, which the distribution compiles with fused multiply-adds on arm64.
# Usage: compare_plans.sh PROGRAM ARM64_PROGRAM SYSROOT
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/../.."

program=$1
arm64_program=$2
sysroot=$3
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

different=0
for problem in problems/*.yaml; do
    name=$(basename "$problem" .yaml)
    for variant in mp-arm-da mp-arm-ada; do
        arguments=(solve "$problem" --variant "$variant" --max-iterations 60 --seed 1 --quiet --no-cache)
        # An exit code of 1 or 3 is a result too: no plan in so few iterations, or a flight that fails.
        "$program" "${arguments[@]}" --out "$out/native" >/dev/null && code=0 || code=$?
        qemu-aarch64 -L "$sysroot" "$arm64_program" "${arguments[@]}" --out "$out/arm64" >/dev/null && other=0 || other=$?
        if [[ $code -eq $other && $code -ne 2 ]] && cmp -s "$out/native/trajectory.csv" "$out/arm64/trajectory.csv" &&
            cmp -s "$out/native/tree.csv" "$out/arm64/tree.csv"; then
            printf '%-24s %-12s the same %6d rows\n' "$name" "$variant" "$(wc -l <"$out/native/trajectory.csv")"
        else
            printf '%-24s %-12s DIFFERENT (exit codes %d and %d)\n' "$name" "$variant" "$code" "$other"
            different=$((different + 1))
        fi
        rm -rf "$out/native" "$out/arm64"
    done
done
[[ $different -eq 0 ]]
