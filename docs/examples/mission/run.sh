#!/usr/bin/env bash
# Flies the mission: builds the programs of this folder against an installed Downwash, starts the simulated vehicle and
# then the mission planner.
# Usage: docs/examples/mission/run.sh PREFIX [cpp|python] [--no-replanning] [options of the vehicle; default: real time]
# The exit code is that of the mission planner, or of the vehicle where that is not 0.
set -euo pipefail

here=$(cd -P "$(dirname "${BASH_SOURCE[0]}")" && pwd)
prefix=$(cd -P "$1" && pwd)
language=${2:-cpp}
build=${MISSION_BUILD:-$prefix/examples-mission}
shift $(($# < 2 ? $# : 2))
mission_options=()
vehicle_options=()
for option in "$@"; do
    if [[ $option == --no-replanning ]]; then
        mission_options+=("$option")
    else
        vehicle_options+=("$option")
    fi
done

if [[ ! -e $build/vehicle ]]; then
    cmake -S "$here" -B "$build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" >&2
    cmake --build "$build" >&2
fi
case $language in
    cpp) mission=("$build/mission") ;;
    python)
        packages=$(dirname "$(find "$prefix" -type d -name downwash -path '*site-packages*')")
        export PYTHONPATH=$packages${PYTHONPATH:+:$PYTHONPATH}
        mission=(/usr/bin/python3 "$here/mission.py") # Debian's own has Debian's NumPy
        ;;
    *)
        echo "$0: cpp or python, not '$language'" >&2
        exit 2
        ;;
esac

problem=$here/bridge.yaml
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$build/vehicle" "$problem" "$folder/socket" "${vehicle_options[@]}" &
vehicle=$!
status=0
"${mission[@]}" "$problem" "$folder/socket" "${mission_options[@]}" || status=$?
wait "$vehicle" || status=$((status > 0 ? status : $?))
exit "$status"
