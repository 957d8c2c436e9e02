#!/usr/bin/env bash
# Whether every planted fault still applies. Exits with 77 without git.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/../.."

command -v git >/dev/null || exit 77
failed=0
for patch in tests/mutants/*/*.patch; do
    # The first line names the test that has to fail. Outside of a repository git takes the folder as it is.
    if ! tail -n +2 "$patch" | git apply --check - 2>/dev/null; then
        echo "$patch does not apply: plant its fault again, git diff -U1 (tests/mutants/README.md)" >&2
        failed=1
    fi
done
exit "$failed"
