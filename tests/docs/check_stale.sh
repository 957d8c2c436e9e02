#!/usr/bin/env bash
# Does bench/stale.sh notice pages that are older than what they measure? Tries it on a small repository.
# Usage: check_stale.sh STALE_SH
set -euo pipefail
stale=$(realpath "$1")
command -v git >/dev/null || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1
git init -q .
git config user.name test
git config user.email test@example.org
mkdir -p bench/results search docs
cp "$stale" bench/stale.sh
commit() {
    git add -A
    git commit -qm "$1"
    git rev-parse HEAD
}
# expect CODE TEXT [--list]: what stale.sh exits with and says.
expect() {
    local code=0 said
    said=$(bench/stale.sh "${@:3}") || code=$?
    said=$(tr -s ' ' <<<"$said")
    if [[ $code != "$1" || $said != *"$2"* ]]; then
        printf 'after "%s": expected %s and "%s", found %s:\n%s\n' "$(git log -1 --format=%s)" "$1" "$2" "$code" "$said" >&2
        exit 1
    fi
}

printf 'group all search\npage all fast.md\n' >bench/results/sources.txt
echo 'It is fast (bench/results/fast.md).' >docs/speed.md
printf '# Results\n\n## Older than the sources\n\n' >bench/results/README.md
echo 'int first;' >search/tree.cpp
measured=$(commit 'sources')
echo "Commit $measured, fast." >bench/results/fast.md
commit 'a page' >/dev/null
expect 0 ''
expect 0 '' --list
echo 'words' >search/README.md
commit 'words about the sources' >/dev/null
expect 0 ''

printf 'moved search planner/search\ngroup all planner/search\npage all fast.md\n' >bench/results/sources.txt
mkdir planner
git mv search planner/search
before=$(commit 'a move')
expect 0 ''

echo 'int second;' >planner/search/tree.cpp
after=$(commit 'other sources')
expect 1 'bench/results/fast.md is stale'
expect 1 "bench/results/fast.md $measured ${after:0:12} planner/search (1)" --list
echo "same all $before..$after the same figures" >>bench/results/sources.txt
expect 0 ''
expect 0 '' --list
sed -i "s/\.\.$after/..HEAD/" bench/results/sources.txt
expect 1 'needs the hashes of two commits'
sed -i "s/\.\.HEAD/..$after/" bench/results/sources.txt
sed -i 's/^group all.*/group all planner\/serch/' bench/results/sources.txt
expect 1 'which is not there'
expect 2 'which is not there' --list
sed -i 's/^group all.*/group all planner\/search/' bench/results/sources.txt
expect 0 ''
echo 'int third;' >planner/search/tree.cpp
echo 'int fourth;' >planner/search/leaf.cpp
third=$(commit 'other sources again')
expect 1 'bench/results/fast.md is stale'
expect 1 "bench/results/fast.md $measured ${third:0:12} planner/search (2)" --list
echo '- [fast.md](fast.md)' >>bench/results/README.md
expect 0 'is listed as older'
echo "Commit $(git rev-parse HEAD), fast." >bench/results/fast.md
expect 1 'take it from the list'
expect 0 '' --list
sed -i 's/, fast/-dirty, fast/' bench/results/fast.md
expect 1 "-dirty ${third:0:12} it was made with changes" --list
sed -i 's/-dirty//' bench/results/fast.md

echo 'It is large (bench/results/large.md).' >>docs/speed.md
git add -A
expect 1 'does not say what it measures'
echo 'Large.' >bench/results/large.md
expect 2 'does not say what bench/results/large.md measures' --list
echo 'page all large.md' >>bench/results/sources.txt
git add -A
expect 1 'names no commit'
expect 1 "bench/results/large.md - ${third:0:12} it names no commit" --list
mkdir unpacked
cp -r bench docs planner unpacked
cd unpacked
expect 77 'whole history'
cd ..
git clone -q --depth 1 "file://$work" shallow
cd shallow
expect 77 'whole history'
echo "stale pages are noticed"
