#!/usr/bin/env bash
# Runs the campaign over the shipped problems and prints its table. Started again after a kill it goes on where it was.
#
#   bench/campaign.sh            five seeds of the bridge, stopping at the first solution (a minute; what CI runs)
#   bench/campaign.sh full       bridge 50 seeds, the others 10, 3 s each; writes bench/results/ (a quarter of an hour)
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

size=${1:-${DOWNWASH_CAMPAIGN_SIZE:-small}}
binary=build/bench/bench_campaign
./dev build --target bench_campaign >&2
commit=$(git describe --always --dirty 2>/dev/null || echo unknown)

if [[ $size != full ]]; then
    out=$(mktemp --suffix .csv)
    trap 'rm -f "$out"' EXIT
    "$binary" problems/bridge_inspection.yaml --out "$out" --commit "$commit" --seeds 5 --stop-at-first \
        --require-aware-success
    exit
fi

mkdir -p bench/results
others=()
for file in problems/*.yaml; do
    [[ $file == problems/bridge_inspection.yaml ]] || others+=("$file")
done
# A table of an earlier commit is kept by git; the file continues only runs of this commit.
for csv in bench/results/bridge.csv bench/results/others.csv; do
    [[ ! -f $csv ]] || head -n 1 "$csv" | grep -qF "commit $commit," || rm "$csv"
done
{
    "$binary" problems/bridge_inspection.yaml --out bench/results/bridge.csv --commit "$commit" --seeds 50 \
        --require-aware-success
    echo
    "$binary" "${others[@]}" --out bench/results/others.csv --commit "$commit" --seeds 10 --require-aware-success
} >bench/results/campaign.md.new
mv bench/results/campaign.md.new bench/results/campaign.md
cat bench/results/campaign.md
