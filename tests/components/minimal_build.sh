#!/usr/bin/env bash
# Builds what a program needs in order to plan (downwash::planner and the modules that it uses) with nothing but the library
# packages of the group [planner] in cmake/debian-packages.txt, installs it, and builds docs/examples/embed against it.
# Usage: tests/components/minimal_build.sh [--configure]
#   --configure   only checks that CMake configures without the other packages and says what it leaves out
# Environment: JOBS, parallel jobs of the build (default 1)
set -euo pipefail

root=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT

# What optional components look for, hidden as if it were not installed.
hidden=()
for package in ZLIB Ceres GeographicLib URDFDOM pugixml fmt SQLite3 CLI11 spdlog; do
    hidden+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
done
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release "${hidden[@]}" >"$build/log" 2>&1 || {
    cat "$build/log"
    exit 1
}
for component in FITTING:libceres-dev IDENTIFICATION:libceres-dev EXPORTS:libgeographiclib-dev ROBOT_IMPORT:liburdfdom-dev REPORT:libfmt-dev \
    CAMPAIGNS:libsqlite3-dev CLI:libcli11-dev; do
    grep -q "^-- Left out: .*Debian packages: .*${component#*:}" "$build/log" || {
        echo "CMake does not say that ${component%:*} is left out without ${component#*:}:"
        grep 'Left out' "$build/log" || true
        exit 1
    }
done
# With the packages of `./dev run` the program is built, without the optional ones.
cmake -S "$root" -B "$build/run" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_DISABLE_FIND_PACKAGE_{Ceres,GeographicLib,SQLite3,URDFDOM}=ON >"$build/log" 2>&1 || {
    cat "$build/log"
    exit 1
}
if left=$(grep -E 'Left out: (the program|pictures)' "$build/log"); then
    echo "CMake leaves out what ./dev run builds: $left"
    exit 1
fi
# Its sources, and all headers that they lead to, include none of a part that is left out.
mapfile -t read < <(sed -n 's|^ *"file": "\(.*\.cpp\)",\{0,1\}$|\1|p' "$build/run/compile_commands.json")
declare -A known
while ((${#read[@]} > 0)); do
    next=()
    while IFS=: read -r file header; do
        if [[ ! -e "$build/run/include/$header" ]]; then
            echo "$file includes $header, which a build for ./dev run does not have"
            exit 1
        fi
        [[ -n ${known[$header]:-} ]] || next+=("$build/run/include/$header")
        known[$header]=1
    done < <(grep -HoP '^#include "\Kdownwash/[^"]+' -- "${read[@]}")
    read=("${next[@]}")
done
((${#known[@]} > 100)) || {
    echo "no more than ${#known[@]} headers were found"
    exit 1
}
[[ ${1:-} != --configure ]] || exit 0

cmake --build "$build" --parallel "${JOBS:-1}"

# Every header that the compiler has read comes from the wanted packages, from what they depend on, or from the compiler's own.
mapfile -t wanted < <(awk '{ sub(/#.*/, "") } /^\[/ { inside = $1 == "[planner]"; next } NF && inside { print $1 }' \
    "$root/cmake/debian-packages.txt")
apt-cache depends --recurse --installed --no-recommends --no-suggests --no-conflicts --no-breaks --no-replaces --no-enhances \
    "${wanted[@]}" g++ | sed -n 's/^\([a-z0-9]\)/\1/p' | sort -u >"$build/allowed"
ninja -C "$build" -t deps | sed -n 's|^ *\(/usr/include/.*\)|\1|p' | sort -u | xargs -r realpath | sort -u |
    xargs -r dpkg -S 2>/dev/null | sed 's/: .*//; s/:[a-z0-9]*$//' | sort -u >"$build/used"
if others=$(grep -vxFf "$build/allowed" "$build/used"); then
    echo "the planner reads headers of packages that are not in the group [planner]:"
    echo "$others"
    exit 1
fi
echo "built with ${wanted[*]} and what they depend on"

"$root/docs/examples/embed/run_consumer_test.sh" "$build"
