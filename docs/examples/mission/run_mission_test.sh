#!/usr/bin/env bash
# Builds the mission planner and its vehicle against an installed Downwash and flies them in lock step: in C++ and, where
# the package is installed, in Python, with the same flight to the last byte. Without planning again, the flight comes too
# close to the deck. In a storm the vehicle drifts, and both plan again. Where the vehicle dies, falls silent or sends garbage, the mission planner says so and ends.
# Usage: docs/examples/mission/run_mission_test.sh PREFIX WORK_FOLDER [--real-time]
# With --real-time it also flies both missions in real time, which takes minutes.
set -euo pipefail

here=$(cd -P "$(dirname "${BASH_SOURCE[0]}")" && pwd)
prefix=$(cd -P "$1" && pwd)
work=$(cd -P "$2" && pwd)
export MISSION_BUILD=$work/mission

fail() {
    echo "$@"
    exit 1
}

# Flies, with what is printed in a file. Usage: fly NAME EXIT_CODES LANGUAGE [options of run.sh]
fly() {
    local name=$1 expected=$2 status=0
    shift 2
    timeout 200 "$here/run.sh" "$prefix" "$@" --log "$work/$name.csv" >"$work/$name.log" 2>&1 || status=$?
    [[ $status == ["$expected"] ]] || fail "$name: exit code $status, not of $expected: $(cat "$work/$name.log")"
}

wait_for_all() {
    local job
    for job in $(jobs -p); do
        wait "$job"
    done
}

# Usage: expect NAME TEXT
expect() {
    grep -qF -- "$2" "$work/$1.log" || fail "$1: no '$2' in $(cat "$work/$1.log")"
}

# Not optimised: what takes time is in the library.
{ cmake -S "$here" -B "$MISSION_BUILD" -DCMAKE_BUILD_TYPE=None -DCMAKE_PREFIX_PATH="$prefix" &&
    cmake --build "$MISSION_BUILD" -j2; } >"$work/log" 2>&1 || fail "$(cat "$work/log")"

languages=(cpp)
if [[ -n $(find "$prefix" -type d -name downwash -path '*site-packages*') ]]; then
    languages+=(python)
fi
for language in "${languages[@]}"; do
    fly "$language" 0 "$language" --lock-step &
done
fly blind 3 cpp --no-replanning --lock-step
wait_for_all
for language in "${languages[@]}"; do
    expect "$language" 'all targets held, plans because of the deck: 1'
    expect "$language" 'lower than believed'
    expect "$language" 'targets held: 1 2 3'
    expect "$language" 'a good flight'
    cmp "$work/cpp.csv" "$work/$language.csv"
done
expect blind 'not a good flight'
grep -F vehicle: "$work/cpp.log" "$work/blind.log" | sed 's/^.*\//    /'

# In gusts far beyond what is planned for the vehicle drifts; whatever becomes of it.
for language in "${languages[@]}"; do
    fly "$language-storm" 013 "$language" --lock-step --gust 6 &
    fly "$language-die" 4 "$language" --lock-step --fail die &
    fly "$language-silence" 4 "$language" --lock-step --fail silence &
    fly "$language-garbage" 4 "$language" --lock-step --fail garbage &
done
wait_for_all
for language in "${languages[@]}"; do
    expect "$language-storm" 'the vehicle has drifted'
    cmp "$work/cpp-storm.csv" "$work/$language-storm.csv"
    expect "$language-die" 'contact with the vehicle is lost: the connection was closed'
    expect "$language-silence" 'contact with the vehicle is lost: no message for 2 s'
    expect "$language-garbage" 'contact with the vehicle is lost: it sent what is no message'
done
echo "    three targets in ${languages[*]}; a vehicle that dies, falls silent or sends garbage is noticed"

if [[ ${3:-} == --real-time ]]; then
    for language in "${languages[@]}"; do
        fly "$language-real" 0 "$language"
        expect "$language-real" 'targets held: 1 2 3'
        cat "$work/$language-real.log"
    done
fi
