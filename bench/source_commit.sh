#!/usr/bin/env bash
# Prints the commit that is measured, with "-dirty" where sources differ from it; results do not count, they come after.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

commit=$(git rev-parse --short=12 HEAD 2>/dev/null) || commit=unknown
if [[ $commit != unknown && -n $(git status --porcelain --untracked-files=no -- . ':!bench/results') ]]; then
    commit+=-dirty
fi
echo "$commit"
