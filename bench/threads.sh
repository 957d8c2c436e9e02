#!/usr/bin/env bash
# Measures searches on one thread and on more, up to the processors of the machine, and writes bench/results/threads.md. About
# three minutes on two processors. Run it on a machine that does nothing else.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_threads >&2
mkdir -p bench/results
build/bench/bench_threads problems/*.yaml "$@" >bench/results/threads.md.new
mv bench/results/threads.md.new bench/results/threads.md
cat bench/results/threads.md
