#!/usr/bin/env bash
# Plans thirty targets in any order, to the first flight and for long, and all legs between them; writes
# bench/results/thirty_targets.md. An hour of two processors.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target downwash bench_legs_in_space >&2
bench/page.sh thirty_targets 'Thirty targets' 'one thread' python3 bench/thirty_targets.py "$@"
