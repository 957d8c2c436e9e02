#!/usr/bin/env bash
# Plans problems in space as they are, turned and shifted, and planar ones in the plane and in space; writes
# bench/results/turned.md. A quarter of an hour of one processor.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target downwash >&2
bench/page.sh turned 'The same problem elsewhere' 'one thread' python3 bench/turned.py "$@"
