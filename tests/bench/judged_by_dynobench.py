#!/usr/bin/env python3
"""Two short plans for dynobench's planar rotor are flights by its rules, and doctored ones are none.

Usage: judged_by_dynobench.py PROGRAM SOURCE_TREE
"""

import pathlib
import subprocess
import sys
import tempfile


def refusal(judge, problem, states, thrusts):
    """Why a flight is refused; empty where it is accepted."""
    try:
        judge.judge(problem, states, thrusts)
    except judge.Refused as why:
        return str(why)
    return ""


def with_item(items, number, item):
    """A copy in which one item is another."""
    return items[:number] + [item] + items[number + 1 :]


def doctored(states, thrusts):
    """Each a flight that is a little different, and what its refusal says."""
    middle = len(states) // 4
    state, thrust = states[middle], thrusts[middle]
    aside = (state[0] + 0.02, *state[1:])
    fast = (*state[:3], 4.5, *state[4:])
    turning = (*state[:5], 9.0)
    return (
        (with_item(states, middle, aside), thrusts, "differs from Euler's"),
        (with_item(states, middle, fast), thrusts, "faster than"),
        (with_item(states, middle, turning), thrusts, "turns faster than"),
        (states, with_item(thrusts, middle, (0.3, thrust[1])), "has a thrust beyond"),
        (states[: middle + 1], thrusts, "no state meets the goal"),
        (states[middle:], thrusts[middle:], "does not begin at the start"),
    )


def main():
    program, tree = sys.argv[1], pathlib.Path(sys.argv[2])
    folder = tree / "bench/dynobench"
    sys.path.insert(0, str(folder))
    import judge  # pylint: disable=import-outside-toplevel

    wrong = []
    for name in ("empty_1", "quad_obs_column"):
        path = folder / f"{name}.yaml"
        with tempfile.TemporaryDirectory() as work:
            run = pathlib.Path(work) / "run"
            command = [program, "solve", path, "--max-iterations", "300", "--no-cache", "--quiet", "--out", run]
            subprocess.run(command, check=True, capture_output=True)
            states, thrusts = judge.read_flight(run)
        problem = judge.read_problem(path)
        if why := refusal(judge, problem, states, thrusts):
            wrong.append(f"{name}: the plan is refused: {why}")
        for other_states, other_thrusts, expected in doctored(states, thrusts):
            why = refusal(judge, problem, other_states, other_thrusts)
            if expected not in why:
                wrong.append(f"{name}: expected '{expected}', found '{why}'")
        blocked = dict(problem, boxes=[*problem["boxes"], (*states[len(states) // 4][:2], 0.1, 0.1)])
        if "touches the box" not in refusal(judge, blocked, states, thrusts):
            wrong.append(f"{name}: a flight through a box is accepted")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
