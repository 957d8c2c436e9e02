#!/usr/bin/env bash
# Flies two worlds of Kino-PAX and writes bench/results/kino_pax.md. SEEDS changes how many searches.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target programs >&2
work=build/kino_pax
rm -rf "$work"
bench/kino_pax/problems.py "$work"
bench/kino_pax/measure.py "$work" --seeds "${SEEDS:-15}" >bench/results/kino_pax.md.new
mv bench/results/kino_pax.md.new bench/results/kino_pax.md
bench/bars.sh --write
cat bench/results/kino_pax.md
