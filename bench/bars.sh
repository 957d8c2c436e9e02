#!/usr/bin/env bash
# Prints how many bars each page of bench/results/ keeps, the commit it was made from, and every bar that is not kept.
# The scripts that write the pages write what this prints to bench/results/bars.md; a test compares them.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/results"
shopt -s extglob
pages=(!(README|bars).md)

awk '
    function page_ends() {
        if (kept + missed > 0) {
            printf("| [%s](%s) | %s | %d | %d |\n", page, page, commit, kept, missed)
        }
    }
    BEGIN { print "# Bars\n\nWhat `bench/bars.sh` finds in the pages beside this one.\n\n| page | commit | kept | not kept |\n| --- | --- | --: | --: |" }
    FNR == 1 { page_ends(); page = FILENAME; commit = "?"; kept = missed = 0 }
    commit == "?" && match($0, /[Cc]ommit:? `?[0-9a-f]+(-dirty)?/) {
        commit = substr($0, RSTART, RLENGTH)
        sub(/[Cc]ommit:? `?/, "", commit)
    }
    / kept \|$/ { ++kept }
    /\*\*not kept\*\* \|$/ {
        ++missed
        row = $0
        sub(/^\| /, "", row)
        sub(/ \| \*\*not kept\*\* \|$/, "", row)
        gsub(/ \| /, ": ", row)
        rows = rows "- " page ": " row "\n"
    }
    END { page_ends(); print (rows == "" ? "\nAll are kept." : "\nNot kept:\n\n" rows) }' \
    "${pages[@]}" | sed -e '$ { /^$/d }'
