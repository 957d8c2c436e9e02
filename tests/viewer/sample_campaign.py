"""Figures of an invented campaign, worked out a second time, independently of the program."""

import math
import random

QUANTILES = (("0", 0), ("25", 0.25), ("50", 0.5), ("75", 0.75), ("95", 0.95))


def share(hits, attempts):
    """With Wilson's interval."""
    if attempts == 0:
        return {"hits": 0, "attempts": 0, "low": 0, "high": 1}
    z, p, n = 1.959963984540054, hits / attempts, attempts
    middle, spread = (p + z * z / (2 * n)), z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    low, high = (middle - spread) / (1 + z * z / n), (middle + spread) / (1 + z * z / n)
    return {"hits": hits, "attempts": attempts, "low": max(0, low), "high": min(1, high)}


def quantile(values, q):
    ordered = sorted(math.inf if v is None else v for v in values)
    at = q * (len(ordered) - 1)
    low, high = ordered[math.floor(at)], ordered[math.ceil(at)]
    found = low if low == high else low + (at - math.floor(at)) * (high - low)
    return found if math.isfinite(found) else None


def spread(values):
    return {name: quantile(values, q) for name, q in QUANTILES}


def cell(problem, planner, seeds, chance, scale):
    dice = random.Random(f"{problem} {planner['planner']}")
    first = [scale * 10 ** dice.gauss(-2, 0.3) for _ in range(seeds)]
    held = [dice.random() < chance for _ in range(seeds)]
    costs = [9000 + 4000 * dice.random() / scale if good else None for good in held]
    causes = [None if good else "collision" for good in held]
    moments = [10 ** (k / 16) for k in range(-32, 1)]

    def costs_at(time_s):
        return [None if t > time_s else (c or 9500) * (1 + t / time_s) for t, c in zip(first, costs)]

    ordered = sorted(first)
    return {
        "problem": problem, "objective": "energy", "cost_unit": "J", **planner, "missing": 0, "solved": share(seeds, seeds),
        "failed_flights": share(held.count(False), seeds), "held": share(held.count(True), seeds),
        "failures_by_cause": {"collision": held.count(False)} if False in held else {},
        "first_solution_s": spread(first), "verified_s": spread(first), "whole_run_s": spread([1] * seeds),
        "flown_cost": spread(costs), "least_clearance_m": 0.05, "discarded": 0,
        "cost_over_time": [{"time_s": t, "cost": spread(costs_at(t))} for t in (0.1, 0.3, 1.0)],
        "cost_curve": [{"time_s": t, "cost": spread(costs_at(t))} for t in moments],
        "solved_over_time": [{"time_s": t, "solved": share(i + 1, seeds)} for i, t in enumerate(ordered)],
        "held_over_cost": [{"cost": c, "held": i + 1} for i, c in enumerate(sorted(c for c in costs if c))],
        "in_worlds": {"tested": seeds, "certified": share(held.count(True), seeds), "first_certified_s": spread(first),
                      "flown": seeds, "failed": share(3 * held.count(False), 10 * seeds),
                      "alone": [{"parameter": "aero.ceiling_scale", "plans": seeds, "failed_low": 0,
                                 "failed_high": held.count(False)}]},
        "seeds": {"seed": list(range(1, seeds + 1)), "cause": causes, "first_solution_s": first,
                  "whole_run_s": [1] * seeds, "flown_cost": costs},
    }


def comparison(experiment, first, second):
    both = [(a, b) for a, b in zip(first["seeds"]["flown_cost"], second["seeds"]["flown_cost"]) if a and b]
    differences = [a - b for a, b in both]
    return {"experiment": experiment, "first": first["planner"], "second": second["planner"], "measure": "executed cost",
            "first_smaller": sum(d < 0 for d in differences), "second_smaller": sum(d > 0 for d in differences),
            "equal": 0, "sign_test_p": 0.5, "pairs": len(both), "median_difference": quantile(differences, 0.5),
            "signed_rank_p": 0.5}


def campaign(problems=("bridge", "pipe_rack"), seeds=20, margins=(None,), parameters=({},)):
    def name_of(variant, values, margin):
        return ", ".join([variant, *(f"{name} {value}" for name, value in values.items()),
                          *([f"margin {margin} m"] if margin else [])])

    planners = [{"planner": name_of(variant, values, margin), "variant": variant, "algorithm": "rrt-star",
                 "parameters": values, "margin_m": margin, "chance": chance, "scale": scale}
                for variant, chance, scale in (("mp-arm-ada", 1, 1), ("mp-arm-da", 0.7, 0.7), ("mp-arm", 0.2, 0.1))
                for values in parameters for margin in margins]
    named = [{key: p[key] for key in ("planner", "variant", "algorithm", "parameters", "margin_m")} for p in planners]
    cells = [cell(problem, name, seeds, p["chance"], p["scale"])
             for problem in problems for p, name in zip(planners, named)]
    count = len(planners)
    totals = []
    for i, name in enumerate(named):
        own = cells[i::count]
        attempts = seeds * len(problems)
        totals.append({**name, "solved": share(attempts, attempts), "discarded": 0,
                       "failed_flights": share(sum(c["failed_flights"]["hits"] for c in own), attempts),
                       "held": share(sum(c["held"]["hits"] for c in own), attempts),
                       "in_worlds": {**own[0]["in_worlds"], "tested": attempts, "flown": attempts, "alone": [],
                                     "certified": share(sum(c["in_worlds"]["certified"]["hits"] for c in own), attempts),
                                     "failed": share(sum(c["in_worlds"]["failed"]["hits"] for c in own), 10 * attempts)}})
    comparisons = [comparison(f"{cells[i]['problem']}, energy", cells[i], cells[i + 1])
                   for i in range(0, len(cells), count)]
    failures = [{"experiment": f"{c['problem']}, energy", "planner": c["planner"], "cause": "collision",
                 "count": c["failed_flights"]["hits"],
                 "seeds": [seed for seed, cause in zip(c["seeds"]["seed"], c["seeds"]["cause"]) if cause],
                 "nearest_approach_m": []}
                for c in cells if c["failed_flights"]["hits"]]
    runs = seeds * len(cells)
    sweep = [{"variant": "mp-arm", "algorithm": "rrt-star", "parameters": values, "safe_margin_m": None,
              "experiments": [{"experiment": f"{problem}, energy", "safe_margin_m": 0.2, "solved_when_safe": share(0, 20),
                               "solved_when_safe_everywhere": None} for problem in problems]}
             for values in parameters]
    return {
        "schema": "downwash/campaign-report/v1",
        "settings": {"campaign": "invented", "description": "Two problems, made up.", "version": "0.0.0",
                     "commit": "0123456789ab", "processor": "a processor", "jobs": 2, "time_limit_s": 1,
                     "max_iterations": None, "seeds": f"1-{seeds}"},
        "runs_planned": runs, "runs_done": runs, "time_limit_s": 1, "stop_at_first_solution": False, "left_out": [],
        "processor_models": 1, "seed_step": 1,
        "machines": [{"host": "a host", "processor": "a processor", "instruction_set": "avx2", "runs": runs, "median_load": 1.5,
                      "max_load": 2}],
        "totals": totals, "cells": cells, "comparisons": comparisons,
        "margins": sweep if margins != (None,) else [], "failures": failures,
        "bars": [{"experiment": "bridge, energy", "planner": "mp-arm-ada", "bar": "failed flights at most 0",
                  "found": "0/20", "kept": True}],
    }
