#!/usr/bin/env bash
# Prints how many bars each page of bench/results/ keeps, the commit it was made from, and every bar that is not kept.
# With --write it becomes bench/results/bars.md, as the scripts that write the pages have it; a test compares them.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/results"
shopt -s extglob
LC_ALL=C
pages=(!(README|bars).md)
if [[ ${1-} == --write ]]; then
    "../${BASH_SOURCE[0]##*/}" >bars.md.new
    mv bars.md.new bars.md
    exit
fi

awk '
    function page_ends() {
        if (kept + missed > 0) {
            printf("| [%s](%s) | %s | %d | %d |\n", page, page, commit, kept, missed)
        }
    }
    BEGIN { print "# Bars\n\nWhat `bench/bars.sh` finds in the pages beside this one.\n\n| page | commit | kept | not kept |\n| --- | --- | --: | --: |" }
    FNR == 1 { page_ends(); page = FILENAME; commit = "?"; kept = missed = 0 }
    commit == "?" && match($0, /[Cc]ommit:? `?[0-9a-f]+(-dirty)?/) && RLENGTH >= 14 {
        commit = substr($0, RSTART, RLENGTH)
        sub(/[Cc]ommit:? `?/, "", commit)
    }
    / kept \|$/ { ++kept }
    /\*\*(not kept|missed)\*\* \|$/ {
        ++missed
        row = $0
        sub(/^\| /, "", row)
        sub(/ \| \*\*(not kept|missed)\*\* \|$/, "", row)
        gsub(/ \| /, ": ", row)
        rows = rows "- " page ": " row "\n"
    }
    END { page_ends(); print (rows == "" ? "\nAll are kept." : "\nNot kept:\n\n" rows) }' \
    "${pages[@]}" | sed -e '$ { /^$/d }'
