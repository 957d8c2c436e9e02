"""Invented comparisons of a flight log with its plan, in the shape of the page's data."""

import math

from sample_page import HOSTILE


def figures(scale):
    def axes(*numbers):
        return dict(zip(("x", "y", "z", "distance"), (scale * number for number in numbers)))

    return {"samples": 5000, "mean_m": axes(0.001, 0, -0.002, 0.02), "rms_m": axes(0.02, 0.01, 0.005, 0.023),
            "max_m": axes(0.06, 0.02, 0.01, 0.064), "max_at_s": 7.25}


def plain_report():
    """A flight with a touch of everything: thrust, worlds, and a log without a position for a second."""
    times = [0.02 * i for i in range(1000)]
    places = [[math.sin(0.3 * t) for t in times], [0.5 * t for t in times], [2 + 0.1 * t for t in times]]
    flown = [[None if 10 < t < 11 else p + 0.02 * math.sin(t) for t, p in zip(times, axis)] for axis in places]
    findings = {
        "schema": "downwash/comparison/v1", "problem": "around_a_girder", "plan": "run",
        "log": {"files": ["flight.ulg"], "format": "ULog", "start_s": 12.5, "duration_s": 300.0, "series": [],
                "axes": "ned", "axes_source": "by format"},
        "alignment": {"offset_s": 81.37, "rate": 1, "is_time_fitted": True, "is_rate_fitted": False, "correlation": 0.987,
                      "yaw_rad": 0.5, "shift_m": [1, 2, 3], "is_frame_fitted": True, "residual_m": 0.018, "covered": 0.95},
        "duration_s": 20.0, "planned_outcome": "ok", "tracking": figures(1), "from_planned_flight": figures(0.8),
        "tracking_apart_from_jumps": figures(0.5),
        "jumps": [{"at_s": 12.0, "what": "position", "step_m": [0.3, 0.4, 0.0], "turn_rad": 0.0,
                   "source": "vehicle_local_position.xy_reset_counter"}],
        "phases": [{"phase": phase, "duration_s": 10.0, "min_clearance_m": 0.3, **figures(1)} for phase in ("transit", "hover")],
        "clearance": {"flown": {"min_m": 0.184, "at_s": 8.26, "obstacle": "bottom_flange"},
                      "planned": {"min_m": 0.2, "at_s": 8.2, "obstacle": "bottom_flange"}, "safety_margin_m": 0.05,
                      "attitude": "log", "joints": "reference"},
        "thrust": {"unit_n": 20.0, "samples": 950, "rms_from_planned_n": 0.4, "rms_from_free_air_n": 0.9,
                   "mean_logged_n": 25.1, "mean_planned_n": 25.0, "mean_free_air_n": 25.3},
        "envelope": {"worlds": 32, "first_world": 1, "seed": 1, "share_outside": 0.031, "expected_axis_share": 2 / 33,
                     "outside": [{"begin_s": 5.0, "end_s": 5.6, "axis": "x", "excess_m": 0.012}]},
        "remarks": ["12 rows are skipped"]}
    series = {"t_s": times, "reference_m": places, "planned_m": places, "flown_m": flown,
              "clearance_m": [0.2 + 0.01 * t for t in times], "planned_clearance_m": [0.21 + 0.01 * t for t in times],
              "thrust_n": [25.0 for _ in times], "planned_thrust_n": [25.1 for _ in times],
              "free_air_thrust_n": [25.3 for _ in times],
              "low_m": [[p - 0.03 for p in axis] for axis in places], "high_m": [[p + 0.03 for p in axis] for axis in places]}
    return {"schema": "downwash/comparison-report/v1", "version": "0.1.0", "command": "downwash compare run flight.ulg",
            "problem": "around_a_girder", "findings": findings, "series": series}


def bare_report():
    """In a plane, in open air, without rotors and worlds; with names of others."""
    report = plain_report()
    report["problem"] = HOSTILE
    findings, series = report["findings"], report["series"]
    findings["log"]["files"] = [HOSTILE]
    findings["remarks"] = [HOSTILE]
    findings.update(thrust=None, envelope=None, jumps=[], tracking_apart_from_jumps=None)
    findings["clearance"]["flown"] = findings["clearance"]["planned"] = {"min_m": None, "at_s": None, "obstacle": None}
    for name in ("thrust_n", "planned_thrust_n", "free_air_thrust_n", "low_m", "high_m"):
        del series[name]
    for name in ("reference_m", "planned_m", "flown_m"):
        series[name] = [series[name][0], [0 for _ in series["t_s"]], series[name][2]]
    for name in ("clearance_m", "planned_clearance_m"):
        series[name] = [None for _ in series["t_s"]]
    return report


CASES = {"plain": plain_report, "bare": bare_report}
