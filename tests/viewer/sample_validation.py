"""Invented validations, in the shape of the page's data."""

import math

import numpy as np

import sample_page
from packing import flight_json

COLUMNS = ("t_s,ref_x_m,ref_z_m,ref_arm_rad,x_m,z_m,pitch_rad,arm_rad,vx_m_s,vz_m_s,clearance_m,ee_x_m,ee_z_m,"
           "energy_j").split(",")
PARAMETERS = {"aero.scene_offset_m.z": 0.62, "aero.ceiling_scale": -0.42, "sensing.position_bias_m z": 0.32,
              "vehicle.com_offset_m.x": -0.25, "vehicle.thrust_scale": 0.17, "vehicle.mass_scale": -0.04,
              "wind.mean_m_s.x": 0.01}


def flight(columns, world, outcome, rows=None, offset=(0, 0)):
    return {"world": world, "outcome": outcome, "scene_offset_m": list(offset), "lateral_m": -0.031,
            "flight": flight_json(COLUMNS, [np.asarray(columns[name])[:rows] for name in COLUMNS])}


def probability(hits, runs):
    spread = 1.96 * math.sqrt(max(hits, 1) * runs) / runs**1.5
    return {"estimate": hits / runs, "low": max(0, hits / runs - spread), "high": min(1, hits / runs + spread)}


def plain_report(run=None):
    """The judge's flight alone, of the plan of that run."""
    run = run or sample_page.solved_report()
    columns = run["_columns"]
    findings = {"outcome": "ok", "min_clearance_m": 0.095, "energy_j": 10288.8, "duration_s": 19.58, "goal_error_m": 0.085,
                "disagreements": []}
    report = {"schema": "downwash/validation-report/v1", "version": "0.1.0", "problem": "bridge_inspection",
              "command": "downwash validate problems/bridge_inspection.yaml --plan run", "findings": findings,
              "is_valid": True, "has_flight_claims": True, "seed": 1, "plan": run["solution"]["plan"], "clearance": None,
              "flights": [flight(columns, None, "ok")]}
    for key in ("description", "scene", "robot", "start", "goals", "goal_order", "limits", "map"):
        report[key] = run[key]
    return report, columns


def worlds_report(failures=664, runs=1000):
    """Flights in worlds, the worst of which break off."""
    report, columns = plain_report()
    report["command"] += f" --runs {runs} --seed 1"
    shares = [failures / runs * (0.4 + 0.13 * i) for i in range(10)]
    worst = [{"world": 2 + 7 * i, "outcome": "collision" if failures > i else "ok", "min_clearance_m": 0.0} for i in range(10)]
    report["findings"].update(
        runs=runs, collisions=failures // 3, lateral_collisions=failures // 30,
        collision_probability=probability(failures // 3, runs), failures=failures,
        failure_probability=probability(failures, runs), clearance_m={"p01": 0.0, "p10": 0.0, "p50": 0.072},
        tracking_error_m={"p50": 0.117, "p90": 0.354, "p99": 0.384},
        run_energy_j={"p50": 9926.98, "p90": 10884.5, "p99": 11486.5}, worst=worst,
        sensitivity=[{"parameter": name, "rank_correlation": value,
                      "failure_share_by_decile": [min(1, share) for share in (shares if value > 0 else shares[::-1])]}
                     for name, value in sorted(PARAMETERS.items())] +
        [{"parameter": "vehicle.delay_s", "rank_correlation": None, "failure_share_by_decile": None}])
    least = [float(np.min(columns["clearance_m"][i:i + 10])) for i in range(0, len(columns["t_s"]), 10)]
    report["clearance"] = {"step_s": 0.1, "minimum": [max(0, 0.5 * c - 0.2) for c in least],
                           "p01": [max(0, 0.6 * c - 0.15) for c in least], "p10": [max(0, 0.8 * c - 0.1) for c in least],
                           "p50": least}
    report["flights"] += [flight(columns, each["world"], each["outcome"], 900 + 100 * i, (0.02, -0.015 * i))
                          for i, each in enumerate(worst[:3])]
    return report, columns


def disputed_report():
    """A file that the judge contradicts, without a flight that holds."""
    report, columns = worlds_report(failures=0, runs=20)
    report["is_valid"] = False
    report["findings"]["outcome"] = "goal_missed"
    report["findings"]["disagreements"] = [
        {"what": "execution.cost", "file": 10083.0, "judge": 10288.8},
        {"what": "execution.outcome", "file": sample_page.HOSTILE, "judge": "goal_missed"}]
    report["problem"] = sample_page.HOSTILE
    return report, columns


def open_air_report():
    """No obstacles, no map, a file without a flight; all worlds keep an infinite clearance."""
    report, columns = worlds_report(failures=1, runs=9)
    report["scene"] = {"bounds": report["scene"]["bounds"], "obstacles": []}
    report.update(map=None, has_flight_claims=False, clearance={"step_s": 0.1, **{key: [None] * 190 for key in (
        "minimum", "p01", "p10", "p50")}})
    report["findings"].update(min_clearance_m=None, clearance_m=dict.fromkeys(("p01", "p10", "p50")))
    for each in report["findings"]["sensitivity"]:
        each.update(rank_correlation=None, failure_share_by_decile=None)
    return report, columns


def five_goals_report():
    return plain_report(sample_page.five_goals_report())


CASES = {"plain": plain_report, "worlds": worlds_report, "disputed": disputed_report, "open-air": open_air_report,
         "five-goals": five_goals_report}
