#!/usr/bin/env bash
# Checks the types of the Python package with mypy, and its stub against the real module with stubtest.
# Usage: tests/python/check_types.sh PYTHON FOLDER_OF_THE_PACKAGE
set -euo pipefail

python=$1
here=$(cd -P "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$2"
"$python" -m mypy --cache-dir "$work" --strict --ignore-missing-imports -p downwash
PYTHONPATH=. "$python" -m mypy.stubtest --allowlist "$here/stubtest_allowed.txt" downwash._core
