#!/usr/bin/env bash
# Runs campaigns of bench/campaigns/ and prints their reports.
#
#   bench/campaigns.sh              all but ci: writes bench/results/NAME.md (four hours on two cores)
#   bench/campaigns.sh NAME...      only these
#   bench/campaigns.sh ci           what every change is held to: prints its report and writes nothing (half a minute)
#
# What a kill leaves is in build/campaigns/COMMIT and gone on with. Exit code 1 when a campaign misses a bar.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target programs >&2
commit=$(sed -n 's/^#define DOWNWASH_SOURCE_COMMIT "\(.*\)"$/\1/p' build/bench/source_commit.hpp)
names=("$@")
[[ ${#names[@]} -gt 0 ]] || names=(bridge saving algorithms cost margins variants all first_certified certified space)

missed=0
for name in "${names[@]}"; do
    out=build/campaigns/$commit/$name
    if [[ $name == ci || $commit == *-dirty || $commit == unknown ]]; then
        rm -rf "$out" # nobody knows which sources made it
    fi
    build/downwash bench run "bench/campaigns/$name.yaml" --out "$out" --resume >&2
    report=$out/report.md
    code=0
    build/downwash bench report "$out" >"$report" || code=$?
    [[ $code -le 1 ]] || exit "$code"
    [[ $code -eq 0 ]] || missed=1
    cat "$report"
    if [[ $name != ci ]]; then
        cp "$report" "bench/results/$name.md"
        bench/bars.sh --write
    fi
done
exit "$missed"
