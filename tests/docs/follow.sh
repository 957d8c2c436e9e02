#!/usr/bin/env bash
# Follows the pages of docs/extending: each is a change to the sources, as diffs, and the commands that build and test it.
# Usage: tests/docs/follow.sh [--check | --print] [PAGE...]   (all pages without any; a page is named effect_model, planner, ...)
#   without an option  each page in a fresh copy of the present tree: apply, build, test
#   --check            only whether the diffs apply; builds nothing
#   --print            one page's diffs, for `git apply`
# Environment: JOBS, parallel jobs of a build (default 1)
set -euo pipefail

root=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
pages=$root/docs/extending
# A tree that is no repository is not taken for a part of one around it, whose paths would not fit.
GIT_CEILING_DIRECTORIES=$(dirname "$root")
export GIT_CEILING_DIRECTORIES

say() { printf '%s\n' "follow.sh: $*" >&2; }
die() {
    say "$@"
    exit 1
}

# fences PAGE KIND: what stands in the page's fences that begin with ```KIND.
fences() {
    awk -v begin="\`\`\`$2" '
        $0 == begin { inside = 1; next }
        inside && $0 == "```" { inside = 0; next }
        inside { print }' "$pages/$1.md"
}

# copy_of FOLDER: the present tree, changes that are not committed included, as a repository of its own.
copy_of() {
    mkdir -p "$1"
    git -C "$root" ls-files -z --cached --others --exclude-standard |
        while IFS= read -r -d '' file; do
            if [[ -e $root/$file ]]; then
                printf '%s\0' "$file"
            fi
        done | tar -C "$root" --null -cf - -T - | tar -C "$1" -xf -
    git -C "$1" init -q
    git -C "$1" add -A
    git -C "$1" -c user.name=follow -c user.email=follow@localhost commit -qm 'The tree that is extended'
}

apply() { # PAGE FOLDER [options of git apply]
    local page=$1 folder=$2
    shift 2
    [[ -n $(fences "$page" diff) ]] || die "docs/extending/$page.md has no diff in it"
    fences "$page" diff | git -C "$folder" apply "$@" || die "a diff of docs/extending/$page.md does not apply (see above)"
}

follow() { # PAGE FOLDER
    local page=$1 folder=$2 commands
    commands=$(fences "$page" 'sh followed')
    [[ -n $commands ]] || die "docs/extending/$page.md has no commands to follow"
    copy_of "$folder"
    apply "$page" "$folder"
    (
        cd "$folder"
        export CMAKE_BUILD_PARALLEL_LEVEL=${JOBS:-1}
        # With ccache what a page does not touch comes from the cache, whatever folder it was built in.
        if command -v ccache >/dev/null; then
            export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$folder CCACHE_NOHASHDIR=1
        fi
        if command -v ninja >/dev/null; then
            export CMAKE_GENERATOR=Ninja
        fi
        cmake -S . -B build -DDOWNWASH_BUILD_TESTS=ON -DDOWNWASH_WERROR=ON >configure.log 2>&1 || {
            cat configure.log >&2
            exit 1
        }
        bash -euo pipefail -c "$commands"
    ) || die "what docs/extending/$page.md says does not work (see above)"
}

mode=follow
case ${1:-} in
    --check | --print) mode=${1#--} && shift ;;
    --*) die "there is no option '$1': expected --check or --print" ;;
esac
[[ $# -gt 0 ]] || mapfile -t all < <(find "$pages" -name '*.md' ! -name README.md -printf '%f\n' | sed 's/\.md$//' | LC_ALL=C sort)
[[ $# -gt 0 ]] || set -- "${all[@]}"
for page in "$@"; do
    [[ -f $pages/$page.md ]] || die "there is no page docs/extending/$page.md"
done

case $mode in
    print)
        for page in "$@"; do
            fences "$page" diff
        done
        ;;
    check)
        command -v git >/dev/null || { say "git is not there: nothing is checked" && exit 77; }
        for page in "$@"; do
            apply "$page" "$root" --check
        done
        ;;
    follow)
        work=$(mktemp -d)
        trap 'rm -rf "$work"' EXIT
        for page in "$@"; do
            say "docs/extending/$page.md"
            follow "$page" "$work/$page"
            rm -rf "${work:?}/$page"
        done
        say "every page leads where it says"
        ;;
esac
