#!/usr/bin/env bash
# Installs the package with pip, without network, from a copy of the checkout into a clean virtual environment, and plans
# with it. Builds all modules: takes minutes.
# Usage: tests/python/check_pip.sh [PYTHON, default: Debian's]
set -euo pipefail

python=${1:-/usr/bin/python3}
root=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

mkdir "$work/copy"
git -C "$root" ls-files -z --cached --others --exclude-standard | tar -C "$root" --null -T - -c | tar -C "$work/copy" -x
# Debian's packages are there: NumPy, setuptools and wheel.
"$python" -m venv --system-site-packages "$work/venv"
"$work/venv/bin/pip" install --no-index --no-build-isolation --no-deps --quiet "$work/copy"
[[ -z $(cd "$work/copy" && find . -maxdepth 1 -name '*.egg-info') ]]
rm -rf "$work/copy"

cd "$work"
"$work/venv/bin/python" - "$root/problems/open_air.yaml" "$work/venv" <<'PYTHON'
import pathlib
import sys

import downwash

assert downwash.__file__.startswith(sys.argv[2]), downwash.__file__
assert "libdownwash_" not in pathlib.Path("/proc/self/maps").read_text()
solution = downwash.solve(downwash.read_problem(sys.argv[1]), variant="mp-arm", max_iterations=50)
solution.write("run")
assert solution.flight.outcome == "ok"
print("planned with downwash", downwash.__version__)
PYTHON
