#!/usr/bin/env bash
# Whether a Python that cannot make wheels is told what to do, in place of "invalid command 'bdist_wheel'".
# Usage: tests/python/check_wheel.sh [PYTHON, default: Debian's]
set -euo pipefail

python=${1:-/usr/bin/python3}
root=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# setuptools as it was before it made wheels: of it, only what setup.py asks for.
mkdir -p "$work/setuptools/command"
echo 'Extension = setup = None' >"$work/setuptools/__init__.py"
touch "$work/setuptools/command/__init__.py"
echo 'class build_ext: pass' >"$work/setuptools/command/build_ext.py"
if (cd "$work" && PYTHONPATH=$work "$python" -S "$root/setup.py" egg_info) 2>"$work/errors"; then
    echo "setup.py went on without a package that makes wheels"
    exit 1
fi
# shellcheck disable=SC2016 # the text itself
grep -qF 'has no package `wheel`' "$work/errors"
grep -qF '/usr/bin/python3 -m venv --system-site-packages' "$work/errors"
