#!/usr/bin/env bash
# Whether every relative link of the Markdown files leads to a file that is there, and every #anchor to a heading of it. Every picture of docs/figures
# has to be shown on a page.
# Usage: tests/docs/check_links.sh [folder, default: that of the project]
set -euo pipefail

cd -P "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}"

# The anchors of a page's headings, as GitHub names them: lower case, blanks to '-', other signs left out.
anchors() {
    awk '/^```/ { inside = !inside }
        !inside && /^#+ / {
            sub(/^#+ +/, "")
            gsub(/\]\([^)]*\)/, "")
            text = tolower($0)
            gsub(/[^a-z0-9 _-]/, "", text)
            gsub(/ /, "-", text)
            print text
        }' "$1"
}

# The targets of a page's links and pictures, those of other sites left out, with their lines.
links() {
    awk '/^ *```/ { inside = !inside }
        !inside {
            rest = $0
            gsub(/`[^`]*`/, "", rest)
            while (match(rest, /\]\([^) ]+/)) {
                print NR "\t" substr(rest, RSTART + 2, RLENGTH - 2)
                rest = substr(rest, RSTART + RLENGTH)
            }
        }' "$1" | grep -vE $'\t[a-z]+:' || true
}

pages=0
count=0
bad=0
while read -r page; do
    pages=$((pages + 1))
    while IFS=$'\t' read -r line target; do
        count=$((count + 1))
        file=${target%%#*}
        path=$page
        [[ -z $file ]] || path=$(dirname "$page")/$file
        if [[ ! -e $path ]]; then
            echo "$page:$line: there is no $file"
            bad=$((bad + 1))
        elif [[ $target == *'#'* && $path == *.md ]] && ! anchors "$path" | grep -qxF -- "${target#*#}"; then
            echo "$page:$line: $path has no heading #${target#*#}"
            bad=$((bad + 1))
        fi
    done < <(links "$page")
done < <(find . \( -path './build*' -o -name .git -o -name downwash-out -o -name .cache \) -prune -o -name '*.md' -print | sed 's|^\./||' | LC_ALL=C sort)
while read -r picture; do
    name=$(basename "$picture")
    if ! grep -qF "figures/$name" README.md docs/*.md; then
        echo "$picture: no page shows it"
        bad=$((bad + 1))
    fi
done < <(find docs/figures -name '*.svg' -o -name '*.png')
echo "$count links in $pages pages, $bad of them wrong"
[[ $count -gt 0 && $bad -eq 0 ]]
