#!/usr/bin/env bash
# Are the pages of bench/results that README.md and docs/ quote older than the sources that they measure? Says so for each
# page, and fails where bench/results/README.md does not list it under "Older than the sources", or lists one that is not.
# bench/results/sources.txt says what each page measures. Exits with 77 where the history of the sources is not at hand.
# Usage: bench/stale.sh [--list] [root of the tree]
#   --list: instead, a line for each page of bench/results that is older than what it measures, quoted or not: the page, its commit, the newest
#   commit of its sources, and which sources have changed since, with the number of files. Exits with 0 if there is none, with 1 if there are
#   some, and with 2 if sources.txt is wrong.
set -euo pipefail
is_list=0
if [[ ${1:-} == --list ]]; then
    is_list=1
    shift
fi
cd -P "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"
results=bench/results
sources=$results/sources.txt

# A tree that was unpacked inside another repository has no history of its own either.
if [[ $(git rev-parse --is-shallow-repository 2>/dev/null || echo true) == true || -n $(git rev-parse --show-prefix) ]]; then
    echo "stale.sh: no clone with its whole history, nothing to compare"
    exit 77
fi

# words KIND KEY: what stands in sources.txt after them.
words() {
    awk -v kind="$1" -v key="$2" '$1 == kind && $2 == key { for (i = 3; i <= NF; ++i) print $i }' "$sources"
}

# contents COMMIT GROUP: the sources of a group at a commit under their names of today, without pages.
contents() {
    local folders
    mapfile -t folders < <(words group "$2")
    git ls-tree -r "$1" | # mode, type, object and, after a tab, path
        awk -v wanted="${folders[*]}" '
            NR != FNR {
                object = $3
                path = $0
                sub(/^[^\t]*\t/, "", path)
                top = path
                sub(/\/.*/, "", top)
                if (top in today) path = today[top] substr(path, length(top) + 1)
                if (path ~ /\.md$/) next
                for (i in folder) if (index(path "/", folder[i] "/") == 1) { print path, object; next }
                next
            }
            NR == 1 { split(wanted, folder, " ") }
            $1 == "moved" { today[$2] = $3 }' "$sources" - | LC_ALL=C sort
}

# is_same FROM TO GROUP
is_same() {
    [[ $(contents "$1" "$3" | sha256sum) == $(contents "$2" "$3" | sha256sum) ]]
}

# is_current COMMIT GROUP: whether the sources have not changed since, but for changes that sources.txt calls the same.
# Leaves in `same_until` the last commit up to which they are the same.
is_current() {
    local commit=$1 ranges range from to moved=1
    mapfile -t ranges < <(awk -v group="$2" '$1 == "same" && $2 == group { print $3 }' "$sources")
    while [[ $moved == 1 ]]; do
        same_until=$commit
        if is_same "$commit" HEAD "$2"; then
            return 0
        fi
        moved=0
        for range in "${ranges[@]}"; do
            from=${range%..*} to=${range#*..}
            if [[ $(git rev-parse "$commit") != $(git rev-parse "$to") ]] && ! git merge-base --is-ancestor "$to" "$commit" &&
                { { git merge-base --is-ancestor "$from" "$commit" && git merge-base --is-ancestor "$commit" "$to"; } || is_same "$commit" "$from" "$2"; }; then
                commit=$to
                moved=1
                break
            fi
        done
    done
    return 1
}

# changed COMMIT GROUP: which sources of a group have changed since, as "aeromap (2), planner (5)": with the number of files.
changed() {
    local folders
    mapfile -t folders < <(words group "$2")
    LC_ALL=C comm -3 <(contents "$1" "$2") <(contents HEAD "$2") |
        awk -v wanted="${folders[*]}" '
            BEGIN { n = split(wanted, folder, " ") }
            seen[$1]++ { next } # a changed file is on both sides
            { for (i = 1; i <= n; ++i) if (index($1 "/", folder[i] "/") == 1) { files[i]++; next } }
            END { for (i = 1; i <= n; ++i) if (files[i]) { printf "%s%s (%d)", comma, folder[i], files[i]; comma = ", " } }'
}

# newest GROUP: the newest commit that changed its sources.
newest() {
    local folders
    mapfile -t folders < <(words group "$1")
    git log -1 --format=%h --abbrev=12 HEAD -- "${folders[@]}" ':(exclude)*.md'
}

failed=0
# A misspelled folder or a range that ends at a name such as HEAD would let every change pass.
while read -r group folder; do
    [[ -e $folder ]] && continue
    echo "$sources: group $group names $folder, which is not there"
    failed=1
done < <(awk '$1 == "group" { for (i = 3; i <= NF; ++i) print $2, $i }' "$sources")
while read -r group range; do
    for commit in "${range%..*}" "${range#*..}"; do
        if [[ ! $commit =~ ^[0-9a-f]{7,40}$ ]] || ! git cat-file -e "$commit^{commit}" 2>/dev/null; then
            echo "$sources: the range $range of group $group needs the hashes of two commits, and $commit is none that is known here"
            failed=1
        fi
    done
done < <(awk '$1 == "same" { print $2, $3 }' "$sources")
while read -r group; do
    [[ -n $(words group "$group") ]] && continue
    echo "$sources: no line describes the group $group"
    failed=1
done < <(awk '$1 == "page" || $1 == "same" { print $2 }' "$sources" | LC_ALL=C sort -u)
[[ $failed == 0 ]] || exit $((1 + is_list))

listed=$(awk '/^## / { inside = $0 == "## Older than the sources" } inside' "$results/README.md" |
    { grep -oE '\]\([a-z_]+\.md\)' || true; } | tr -d ']()')
if [[ $is_list == 1 ]]; then # bars.md counts what the others say
    mapfile -t pages < <(cd "$results" && find . -name '*.md' ! -name bars.md | sed 's|^\./||' | LC_ALL=C sort)
else
    mapfile -t pages < <(git grep -ohE "$results/[a-z_]+\.md" -- README.md docs | sed "s|^$results/||" | LC_ALL=C sort -u)
fi
older=0
for page in "${pages[@]}"; do
    [[ $page != README.md ]] || continue
    group=$(awk -v page="$page" '$1 == "page" { for (i = 3; i <= NF; ++i) if ($i == page) print $2 }' "$sources")
    if [[ -z $group ]]; then
        if [[ $is_list == 1 ]]; then
            echo "$sources does not say what $results/$page measures"
        else
            echo "$results/$page is quoted, but $sources does not say what it measures"
        fi
        failed=$((1 + is_list))
        continue
    fi
    commit=$({ grep -oiE 'commit `?[0-9a-f]{7,40}(-dirty)?' "$results/$page" || true; } | head -n 1 | sed 's/.*[ `]//')
    reason=
    if [[ -z $commit ]]; then
        reason="it names no commit"
    elif [[ $commit == *-dirty ]]; then
        reason="it was made with changes that were not committed"
    elif ! git cat-file -e "$commit^{commit}" 2>/dev/null; then
        reason="its commit $commit is not known here"
    elif ! is_current "$commit" "$group"; then
        reason="what it measures (group $group of sources.txt) has changed since commit $commit"
    fi
    if [[ $is_list == 1 ]]; then
        [[ -n $reason ]] || continue
        older=$((older + 1))
        what=$reason
        if git cat-file -e "${commit%-dirty}^{commit}" 2>/dev/null; then
            [[ $commit != *-dirty ]] || is_current "${commit%-dirty}" "$group" || true
            what=$(changed "$same_until" "$group")
            [[ $commit != *-dirty ]] || what="${what:+$what; }$reason"
        fi
        printf '%-34s  %-18s  %-12s  %s\n' "$results/$page" "${commit:--}" "$(newest "$group")" "$what"
        continue
    fi
    is_listed=$(grep -cxF "$page" <<<"$listed" || true)
    if [[ -n $reason && $is_listed == 0 ]]; then
        echo "$results/$page is stale: $reason. Make it anew, or list it in $results/README.md"
        failed=1
    elif [[ -z $reason && $is_listed != 0 ]]; then
        echo "$results/$page is as new as its sources: take it from the list in $results/README.md"
        failed=1
    elif [[ -n $reason ]]; then
        echo "$results/$page is listed as older than its sources: $reason"
    fi
done
if [[ $is_list == 1 && $failed == 0 ]]; then
    exit $((older > 0))
fi
exit "$failed"
