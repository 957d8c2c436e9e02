#!/usr/bin/env bash
# Imports the models of this folder with the program, checks what it wrote, and looks at errors and exit codes.
# Usage: tests/robot_import/import_and_check.sh PROGRAM
set -euo pipefail

downwash=$(realpath "$1")
models=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/models" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() {
    echo "$1"
    exit 1
}

"$downwash" robot import "$models/hexa_arm2.urdf" -o hexa.yaml >out
grep -q 'reach  *0.5719 m' out || fail "the summary has no reach: $(cat out)"
"$downwash" check hexa.yaml >/dev/null
"$downwash" margins hexa.yaml >/dev/null

"$downwash" robot import "$models/quad_arm1.sdf" -o sdf.yaml >/dev/null 2>warnings
grep -q 'is askew' warnings || fail "no warning of the askew box: $(cat warnings)"
"$downwash" robot import "$models/quad_arm1.xml" -o mjcf.yaml --rotor-radius-m 0.1 >/dev/null
for robot in sdf mjcf; do
    "$downwash" check "$robot.yaml" >/dev/null
done

# A file that is wrong is not written; each error has its place.
code=0
"$downwash" robot import "$models/hexa_arm2.urdf" -o none.yaml --rotors 'nothing.*' 2>err || code=$?
[[ $code -eq 2 && ! -e none.yaml ]] || fail "a wrong import ends with $code"
grep -q 'hexa_arm2.urdf:1:1: --rotors' err || fail "the error has no place: $(cat err)"
code=0
"$downwash" robot import "$models/hexa_arm2.urdf" -o none.yaml --freeze elbow 2>err || code=$?
{ [[ $code -eq 2 ]] && grep -q 'expected JOINT=DEG' err; } || fail "--freeze without an angle: $(cat err)"

"$downwash" robot import "$models/hexa_arm2.urdf" -o one.yaml --freeze elbow=45 --name one --json >out.json
python3 -c '
import json
made = json.load(open("out.json"))
assert made["robot"] == "one" and made["joints"] == 1 and abs(made["mass_kg"] - 3.33) < 1e-9, made
assert len(made["hover_share"]) == 6 and 0.4 < sum(made["hover_share"]) / 6 < 0.7, made
'
"$downwash" check one.yaml >/dev/null
# A model of another program is shown as it would be imported; `downwash` leaves it to downwash-robot.
"$downwash" robot show "$models/hexa_arm2.urdf" >out
grep -q 'hexa_arm2, in space' out || fail "the model is not shown: $(cat out)"
"$downwash" robot show one.yaml --json >shown.json
python3 -c '
import json
made, shown = json.load(open("out.json")), json.load(open("shown.json"))
assert len(shown["links"]) == 1 and abs(shown["mass_kg"] - 3.33) < 1e-9, shown
for share, rotor in zip(made["hover_share"], shown["rotors"]):
    assert abs(share - rotor["hover_share"]) < 1e-9, (made, shown)
'
echo "imported robots are sound"
