#!/usr/bin/env bash
# Makes a wheel from a build folder, without compiling anew, and plans with it in a clean virtual environment: module and
# libraries are those of the wheel. A build of another source tree, or of another Python, is told so.
# Usage: tests/python/check_wheel_of_build.sh PYTHON BUILD_FOLDER PROBLEMS
set -euo pipefail

python=$1
build=$2
problems=$3
root=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
wheel() { "$python" -m pip wheel --no-index --no-build-isolation --no-deps --quiet --wheel-dir "$work/wheels" "$root" 2>"$work/errors"; }

before=$(stat --format=%Y "$build/CMakeCache.txt")
DOWNWASH_BUILD=$build wheel || {
    cat "$work/errors"
    exit 1
}
[[ $(stat --format=%Y "$build/CMakeCache.txt") == "$before" ]] || {
    echo "the build was configured anew"
    exit 1
}
"$python" -m venv --without-pip "$work/venv"
site=$("$work/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
(cd "$site" && "$python" -m zipfile -e "$work"/wheels/downwash-*.whl .)
[[ -z $(find "$site/downwash" -name 'libdownwash_*' -type l) ]]
numpy=$("$python" -c 'import numpy, os; print(os.path.dirname(numpy.__file__))')
ln -s "$numpy" "$site/numpy"

cd "$work"
env -u PYTHONPATH "$work/venv/bin/python" - "$problems/open_air.yaml" "$site" <<'PYTHON'
import pathlib
import sys

import downwash

assert downwash.__file__.startswith(sys.argv[2]), downwash.__file__
mapped = pathlib.Path("/proc/self/maps").read_text()
libraries = {line.split()[-1] for line in mapped.splitlines() if "libdownwash_" in line}
assert libraries and all(path.startswith(sys.argv[2]) for path in libraries), libraries
solution = downwash.solve(downwash.read_problem(sys.argv[1]), variant="mp-arm", max_iterations=50)
assert solution.flight.outcome == "ok"
PYTHON

mkdir "$work/other"
echo "CMAKE_HOME_DIRECTORY:INTERNAL=/elsewhere" >"$work/other/CMakeCache.txt"
if DOWNWASH_BUILD=$work/other wheel; then
    echo "a build of another source tree was taken"
    exit 1
fi
grep -qF "is a build of /elsewhere, not of $root" "$work/errors"
if DOWNWASH_BUILD=$work/nothing wheel; then
    echo "a folder without a build was taken"
    exit 1
fi
grep -qF "is no build folder of CMake" "$work/errors"
