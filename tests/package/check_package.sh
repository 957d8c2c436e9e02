#!/usr/bin/env bash
# Unpacks a Debian package of Downwash into a folder and uses what is in it: the program plans, the Python package plans, and the
# package says what it depends on. Installs nothing.
# Usage: tests/package/check_package.sh PACKAGE.deb [PYTHON, default: Debian's]
set -euo pipefail

package=$(realpath -- "$1")
python=${2:-/usr/bin/python3}
root=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
    echo "$(basename "$package"): $*" >&2
    exit 1
}

dpkg-deb -x "$package" "$work/root"
usr=$work/root/usr
cd "$work"

# Of the program and its libraries, nothing comes from the build or from elsewhere on this machine.
mapfile -t found < <(ldd "$usr/bin/downwash" | awk '/libdownwash_/ { print $3 }')
[[ ${#found[@]} -gt 5 ]] || fail "the program finds ${#found[@]} of its libraries"
for library in "${found[@]}"; do
    [[ $(realpath -- "$library") == "$usr"/* ]] || fail "the program takes $library"
done
grep -rlF "$root/build" "$usr" >"$work/leaks" || true
[[ ! -s $work/leaks ]] || fail "the folder of the build is named in $(tr '\n' ' ' <"$work/leaks")"

[[ $("$usr/bin/downwash" --version) == *"$(dpkg-deb -f "$package" Version)"* ]] || fail "the program has another version"
"$usr/bin/downwash" solve "$usr/share/downwash/problems/open_air.yaml" --max-iterations 100 --no-cache --quiet --out run >/dev/null
grep -qF '"status": "solved"' run/solution.json || fail "the program does not solve open_air"
# A command of each optional component starts: its program and libraries are there.
for command in validate export bench study; do
    "$usr/bin/downwash" "$command" --help >/dev/null || fail "downwash $command does not start"
done

for file in share/man/man1/downwash-solve.1 share/bash-completion/completions/downwash share/zsh/vendor-completions/_downwash \
    share/fish/vendor_completions.d/downwash.fish include/downwash/planner/planner.hpp share/doc/downwash/LICENSE; do
    [[ -e $usr/$file || -e $usr/$file.gz ]] || fail "there is no $file"
done
[[ -n $(find "$usr" -name downwash-config.cmake) ]] || fail "CMake finds no package"

# What it depends on are packages that this machine, on which it runs, has.
depends=$(dpkg-deb -f "$package" Depends)
for wanted in libc6 libompl libyaml-cpp libfcl libssl; do
    [[ $depends == *"$wanted"* ]] || fail "does not depend on $wanted: $depends"
done
tr ',' '\n' <<<"$depends" | sed -E 's/^ *//; s/[ |].*//' | while read -r name; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$name" | grep -qx installed || fail "depends on $name, which is not installed here"
done
dpkg-deb --ctrl-tarfile "$package" | tar -xO ./postinst | grep -qw ldconfig || fail "does not tell the linker of its libraries"

if [[ -d $usr/lib/python3/dist-packages/downwash ]]; then
    [[ $(dpkg-deb -f "$package" Recommends) == *python3-numpy* ]] || fail "does not recommend NumPy"
    PYTHONPATH=$usr/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 "$python" - "$usr" <<'PYTHON'
import pathlib
import sys

import downwash

root = sys.argv[1]
assert downwash.__file__.startswith(root), downwash.__file__
libraries = {line.split()[-1] for line in pathlib.Path("/proc/self/maps").read_text().splitlines() if "libdownwash_" in line}
assert libraries and all(path.startswith(root) for path in libraries), libraries
problem = downwash.read_problem(root + "/share/downwash/problems/open_air.yaml")
assert downwash.solve(problem, max_iterations=100).status == "solved"
PYTHON
fi
echo "$(basename "$package"): planned, $(du -h "$package" | cut -f1), depends on $(tr ',' '\n' <<<"$depends" | wc -l) packages"
