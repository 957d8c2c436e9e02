#!/usr/bin/env bash
# Installs a build's Python package into a scratch folder and imports it in a fresh virtual environment, with Debian's
# NumPy alone: plans, writes, and needs neither the build folder nor pandas and matplotlib.
# Usage: tests/python/check_install.sh PYTHON BUILD_FOLDER PROBLEMS
set -euo pipefail

python=$1
build=$2
problems=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/installed" >"$work/install.log" || {
    cat "$work/install.log"
    exit 1
}
"$python" -m venv --without-pip "$work/venv"
site=$("$work/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
dirname "$(find "$work/installed" -type d -name downwash -path '*site-packages*')" >"$site/downwash.pth"
numpy=$("$python" -c 'import numpy, os; print(os.path.dirname(numpy.__file__))')
ln -s "$numpy" "$site/numpy"

cd "$work"
env -u PYTHONPATH "$work/venv/bin/python" - "$problems/open_air.yaml" "$work/installed" <<'PYTHON'
import importlib.util
import pathlib
import sys

import downwash

assert downwash.__file__.startswith(sys.argv[2]), downwash.__file__
assert importlib.util.find_spec("pandas") is None and importlib.util.find_spec("matplotlib") is None
mapped = pathlib.Path("/proc/self/maps").read_text()
libraries = {line.split()[-1] for line in mapped.splitlines() if "libdownwash_" in line}
assert libraries and all(path.startswith(sys.argv[2]) for path in libraries), libraries
solution = downwash.solve(downwash.read_problem(sys.argv[1]), variant="mp-arm", max_iterations=50)
solution.write("run")
assert pathlib.Path("run/solution.json").is_file() and solution.flight.outcome == "ok"
PYTHON
