#!/usr/bin/env bash
# Flies the simulated vehicle over UDP. A streamer that goes leaves a hover. Given a Python that has the package, a whole flight follows, with
# a link that loses frames and an obstacle that turns out lower, of the streamer and of stream.py: both say the same.
# Usage: docs/examples/offboard/run_offboard_test.sh VEHICLE STREAM PYTHON|none PROBLEM.yaml OBSTACLE ITERATIONS
set -euo pipefail

here=$(cd -P "$(dirname "${BASH_SOURCE[0]}")" && pwd)
vehicle=$1 stream=$2 python=$3 problem=$4 obstacle=$5 iterations=$6
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
instance=$((RANDOM % 15000))

# fly NAME STREAMER_CODE VEHICLE_OPTIONS -- STREAMER...: a flight whose output is $work/NAME and $work/NAME.vehicle. The vehicle has to hover.
fly() {
    local name=$1 expected=$2 options=() code=0
    shift 2
    while [[ $1 != -- ]]; do options+=("$1") && shift; done
    shift
    "$vehicle" "$problem" --lock-step --instance "$instance" "${options[@]}" >"$work/$name.vehicle" &
    local pid=$!
    "$@" "$problem" --instance "$instance" --iterations "$iterations" >"$work/$name" || code=$?
    [[ $code -eq $expected ]] || { kill "$pid" && cat "$work/$name" && echo "$name: the streamer ends with $code instead of $expected" >&2 && exit 1; }
    wait "$pid" || { cat "$work/$name"* && echo "$name: the vehicle does not hover" >&2 && exit 1; }
    cat "$work/$name" "$work/$name.vehicle"
    instance=$((instance + 1))
}
# says NAME LINE: whether a flight has said that.
says() {
    grep -qF -- "$2" "$work/$1" || { echo "$1: no '$2'" >&2 && exit 1; }
}

fly gone 1 -- "$stream" --stop-after 5
says gone.vehicle 'ends in hold, since set-points did not come'
[[ $python != none ]] || exit 0

faults=(--loss 0.02 --jitter 0.01 --lower "$obstacle" 0.05)
fly cpp 0 "${faults[@]}" -- "$stream" --lower "$obstacle" 0.05
says cpp 'is 0.050 m lower than on the drawing'
says cpp.vehicle 'ends in hold'
fly python 0 "${faults[@]}" -- "$python" "$here/stream.py" --lower "$obstacle" 0.05
diff "$work/cpp" "$work/python" >&2
diff "$work/cpp.vehicle" "$work/python.vehicle" >&2
