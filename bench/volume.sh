#!/usr/bin/env bash
# Measures what the first look-ups of volumes cost and how exact they are, and writes bench/results/volume.md. A minute.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_volume >&2
mkdir -p bench/results
build/bench/bench_volume "$@" >bench/results/volume.md.new
mv bench/results/volume.md.new bench/results/volume.md
bench/bars.sh --write
cat bench/results/volume.md
