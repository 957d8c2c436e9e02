#!/usr/bin/env bash
# Runs what is missing of the study of awareness and writes bench/results/awareness.md. About seven hours on two processors;
# close everything else first. It can be stopped and started again. Options go to `downwash study awareness`, for example
# --share 1/2, or --line certified-10s --seeds 50.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target programs >&2
out=downwash-out/study-awareness
build/downwash study awareness --out "$out" "$@" >/dev/null
mkdir -p bench/results
cp "$out/study.md" bench/results/awareness.md.new
mv bench/results/awareness.md.new bench/results/awareness.md
echo "bench/results/awareness.md is written"
