#!/usr/bin/env python3
"""Short plans for dynobench's quadrotors are flights by its rules, and doctored ones are none.

Usage: quadrotors_by_dynobench.py PROGRAM SOURCE_TREE
"""

import pathlib
import subprocess
import sys
import tempfile

from judged_by_dynobench import with_item


def refusal(judge, *flight):
    """Why a flight is refused; empty where it is accepted."""
    try:
        judge.judge(*flight)
    except judge.Refused as why:
        return str(why)
    return ""


def doctored(states, thrusts):
    """Each a flight that is a little different, and what its refusal says."""
    middle = len(states) // 8
    state = states[middle]
    aside = (state[0] + 0.02, *state[1:])
    fast = (*state[:7], 4.5, *state[8:])
    turning = (*state[:10], 9.0, *state[11:])
    strong = tuple(2 * thrust for thrust in thrusts[middle])
    return (
        (with_item(states, middle, aside), thrusts, "differs from Euler's"),
        (with_item(states, middle, fast), thrusts, "component of velocity"),
        (with_item(states, middle, turning), thrusts, "component of angular velocity"),
        (states, with_item(thrusts, middle, strong), "has a control beyond"),
        (states[: middle + 1], thrusts, "no state meets the goal"),
        (states[middle:], thrusts[middle:], "does not begin at the start"),
    )


def main():
    program, tree = sys.argv[1], pathlib.Path(sys.argv[2])
    folder = tree / "bench/dynobench"
    sys.path.insert(0, str(folder))
    import judge_in_space as judge  # pylint: disable=import-outside-toplevel

    wrong = []
    with tempfile.TemporaryDirectory() as work:
        subprocess.run([sys.executable, folder / "space_problems.py", work], check=True)
        for name in ("v0_recovery", "v1_quad_one_obs"):
            path, run = pathlib.Path(work) / f"{name}.yaml", pathlib.Path(work) / name
            command = [program, "solve", path, "--max-iterations", "200", "--no-cache", "--quiet", "--out", run]
            subprocess.run(command, check=True, capture_output=True)
            states, thrusts = judge.read_flight(run)
            model, problem = judge.MODELS[name[:2]], judge.read_problem(path)
            if why := refusal(judge, model, problem, states, thrusts):
                wrong.append(f"{name}: the plan is refused: {why}")
            for other_states, other_thrusts, expected in doctored(states, thrusts):
                why = refusal(judge, model, problem, other_states, other_thrusts)
                if expected not in why:
                    wrong.append(f"{name}: expected '{expected}', found '{why}'")
            blocked = dict(problem, boxes=[*problem["boxes"], (states[len(states) // 8][:3], (0.1, 0.1, 0.1))])
            if "is in the box" not in refusal(judge, model, blocked, states, thrusts):
                wrong.append(f"{name}: a flight through a box is accepted")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
