#!/usr/bin/env bash
# Plans thirty targets in any order, to the first flight and for long; writes bench/results/thirty_targets.md.
# Forty minutes of one processor.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target downwash >&2
bench/page.sh thirty_targets 'Thirty targets' 'one thread' python3 bench/thirty_targets.py "$@"
