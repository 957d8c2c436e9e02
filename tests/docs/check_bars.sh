#!/usr/bin/env bash
# Whether bench/bars.sh counts what pages of either kind say of their bars, and lists those that are missed.
# Usage: tests/docs/check_bars.sh PATH_OF_BARS_SH
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/results"
cp "$1" "$folder/bars.sh"
cat >"$folder/results/page.md" <<'PAGE'
Of each commit a page.
Commit `abcdef012345`.
| first | 1 s | kept |
| second | 2 s | **missed** |
| third | 3 s | **not kept** |
PAGE
found=$("$folder/bars.sh")
for expected in '| [page.md](page.md) | abcdef012345 | 1 | 2 |' '- page.md: second: 2 s' '- page.md: third: 3 s'; do
    grep -qxF -e "$expected" <<<"$found" || { printf 'not found: %s\nin\n%s\n' "$expected" "$found"; exit 1; }
done
