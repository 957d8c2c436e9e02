#!/usr/bin/env bash
# Runs what measures, and makes a page of bench/results of what it prints: below a title, the commit and the processor.
# Usage: bench/page.sh NAME TITLE CONDITIONS COMMAND [ARGUMENT...]
#   NAME: of the page and of the script that makes it, bench/NAME.sh   CONDITIONS: for example "2 threads"
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

name=$1 title=$2 conditions=$3
shift 3
page=bench/results/$name.md
mkdir -p bench/results
{
    # shellcheck disable=SC2016 # these are Markdown's
    printf '# %s\n\nCommit %s, %s, %s. Made by `bench/%s.sh`.\n\n' "$title" "$(bench/source_commit.sh)" \
        "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)" "$conditions" "$name"
    "$@"
} >"$page.new"
mv "$page.new" "$page"
bench/bars.sh --write
cat "$page"
