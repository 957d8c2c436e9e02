#!/usr/bin/env bash
# Flies a mission with the program and, given a Python that has the package, with mission.py: both say the same, to the last digit.
# Usage: docs/examples/mission_in_space/run_mission_test.sh PROGRAM PYTHON|none PROBLEM.yaml OBSTACLE ITERATIONS
set -euo pipefail

here=$(cd -P "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$1 python=$2
shift 2
said=$("$program" "$@")
echo "$said"
for line in 'is 0.050 m lower than on the drawing' 'certificate: '; do
    grep -qF -- "$line" <<<"$said" || { echo "no '$line'" >&2 && exit 1; }
done
if [[ $python != none ]]; then
    diff <(echo "$said") <("$python" "$here/mission.py" "$@") >&2
fi
