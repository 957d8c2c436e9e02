#!/usr/bin/env python3
"""A small mission planner on the Python package of Downwash: mission.cpp, decision by decision.

It commands a vehicle in another process through a list of targets: it plans to the next one, sends the reference, follows
the telemetry, and plans again when the deck turns out to be elsewhere or the vehicle is not where it should be.

Usage: mission.py PROBLEM.yaml SOCKET [--no-replanning]
Exit codes: 0 all targets held, 1 broken off, 2 bad input, 3 the vehicle's flight has failed, 4 the vehicle is gone.
"""

from __future__ import annotations

import dataclasses
import json
import math
import socket
import sys
import time
from typing import Any

import downwash
import numpy as np

LEAD_IN_FLIGHT_S = 1  # from the telemetry that a plan is made from to its first tick
LEAD_IN_HOVER_S = 3  # the same where there is time
PLANNING_SHARE = 0.8  # of the lead, for planning
ITERATIONS = 3000  # of a search in lock step, where time does not count
READINGS = 50  # of the range finder for a mean: exact to some millimetres
MAX_DRIFT_M = 0.15
MAX_ATTEMPTS = 6  # plans for one target
TIMEOUT_S = 2

# What a message of a type has to have.
NUMBERS = {
    "hello": ("tick_s",),
    "telemetry": ("tick", "x_m", "z_m", "pitch_rad", "arm_rad", "vz_m_s"),
    "accepted": ("id",),
}
OTHERS = {"hello": ("lock_step",), "telemetry": ("range_up_m",), "rejected": ("reason",), "ended": ("outcome",)}


class MissionFailed(Exception):
    """There is no way on."""


class FlightFailed(Exception):
    """The vehicle's flight is over before the mission is."""


class ConnectionLost(Exception):
    """The vehicle is silent, gone, or says what cannot be understood."""


@dataclasses.dataclass
class Command:
    """A reference for the vehicle, and the vehicle with which it begins."""

    from_tick: int
    start: downwash.Start
    plan: downwash.Columns
    advice: str
    tick_s: float

    @property
    def leads_to_target(self) -> bool:
        return self.advice in ("follow", "keep")

    @property
    def end_tick(self) -> int:
        return self.from_tick + round(float(self.plan["t_s"][-1]) / self.tick_s)


class VehicleLink:
    """The messages between mission planner and vehicle (README.md), as JSON over a socket."""

    def __init__(self, path: str) -> None:
        self._socket = self._connected(path, time.monotonic() + 10)
        self._socket.settimeout(TIMEOUT_S)
        self._arrived = b""
        self._sent: list[Command] = []
        self._is_waiting = False
        self.accepted: Command | None = None
        hello = self._message()
        if hello["type"] != "hello":
            raise ConnectionLost("it does not say hello")
        self.tick_s = float(hello["tick_s"])
        self.is_lock_step = bool(hello["lock_step"])

    @staticmethod
    def _connected(path: str, until: float) -> socket.socket:
        while True:
            connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            try:
                connection.connect(path)
                return connection
            except OSError as error:
                connection.close()
                if time.monotonic() > until:
                    raise ConnectionLost(f"no vehicle listens at {path}: {error}") from None
                time.sleep(0.02)

    def next(self) -> dict[str, Any]:
        """Waits for the next row of telemetry."""
        if self.is_lock_step and self._is_waiting:
            self._send({"type": "go"})
        self._is_waiting = True
        while True:
            message = self._message()
            if message["type"] == "telemetry":
                return message
            if message["type"] == "accepted":
                number = int(message["id"])
                if not 0 <= number < len(self._sent):
                    raise ConnectionLost(f"it accepts reference {number}, which nobody sent")
                self.accepted = self._sent[number]
            elif message["type"] == "rejected":
                print(f"            the vehicle rejects a reference: {message['reason']}")
            elif message["type"] == "ended":
                raise FlightFailed(f"the vehicle's flight has ended: {message['outcome']}")

    def send(self, command: Command) -> None:
        """The vehicle follows a command from its tick on, in place of those that begin no earlier, if it comes in time."""
        reference = {name: column.tolist() for name, column in command.plan.items()}
        message = {"type": "reference", "id": len(self._sent), "from_tick": command.from_tick, "reference": reference}
        self._send(message)
        self._sent.append(command)

    def end(self) -> None:
        """Ends the mission, and waits until the vehicle has heard it."""
        self._send({"type": "end"})
        while self._message()["type"] != "ended":
            pass

    def _send(self, message: dict[str, Any]) -> None:
        try:
            self._socket.sendall(json.dumps(message).encode() + b"\n")
        except OSError as error:
            raise ConnectionLost(f"the connection is gone: {error}") from None

    def _message(self) -> dict[str, Any]:
        while b"\n" not in self._arrived:
            try:
                some = self._socket.recv(4096)
            except socket.timeout:
                raise ConnectionLost(f"no message for {TIMEOUT_S} s") from None
            except OSError as error:
                raise ConnectionLost(f"the connection is gone: {error}") from None
            if not some:
                raise ConnectionLost("the connection was closed")
            self._arrived += some
        line, self._arrived = self._arrived.split(b"\n", 1)
        try:
            message: dict[str, Any] = json.loads(line)
            for name in NUMBERS.get(message["type"], ()):
                float(message[name])
            for name in OTHERS.get(message["type"], ()):
                _ = message[name]
            return message
        except (KeyError, TypeError, ValueError):
            raise ConnectionLost(f"it sent what is no message: {line[:80].decode(errors='replace')}") from None


def mean(values: list[float]) -> float:
    return sum(values) / len(values)


class Bridge:
    """The bridge as it is believed to be: its deck, and the targets, of which some hang on it."""

    def __init__(self, problem: downwash.Problem) -> None:
        decks = [each for each in problem["environment.obstacles"] if each["name"] == "deck" and "box" in each]
        goals = problem["goal"]
        self.targets = goals if isinstance(goals, list) else [goals]
        if not decks or not all("end_effector" in each for each in self.targets):
            raise downwash.InputError("a mission needs a box called 'deck' and a list of places for the end effector")
        self.deck = decks[0]

    @property
    def underside_m(self) -> float:
        return float(self.deck["box"]["center_m"][2] - 0.5 * self.deck["box"]["size_m"][2])

    def lower_deck(self, by_m: float) -> None:
        """Moves the deck down, and the targets that hang on it: those less than 0.2 m below its underside."""
        for target in self.targets:
            if target["end_effector"]["z_m"] > self.underside_m - 0.2:
                target["end_effector"]["z_m"] -= by_m
        self.deck["box"]["center_m"][2] -= by_m


class Mission:
    def __init__(self, link: VehicleLink, problem: downwash.Problem, replans: bool) -> None:
        self._link = link
        self._replans = replans
        self._bridge = Bridge(problem)
        self._arm_m: float = problem["robot.arm.length_m"]
        self._delay_s: float = problem["robot.controller.delay_s"]
        limits = {
            "planner.max_iterations": ITERATIONS if link.is_lock_step else None,
            "planner.time_limit_s": None if link.is_lock_step else PLANNING_SHARE * LEAD_IN_HOVER_S,
        }
        first_leg = problem.replace({"goal": self._bridge.targets[0], **limits})
        self._planner = downwash.Planner(first_leg, threads=2, stop_at_first=True)
        self._rows: list[dict[str, Any]] = []
        self._lower_m: list[float] = []  # readings of how much lower than believed the deck is
        self._number = 0  # of the target
        self._attempts = 0
        self._deck_plans = 0

    def run(self) -> None:
        self._read_telemetry()
        for self._number in range(len(self._bridge.targets)):
            self._attempts = 0
            if self._number == 0:
                self._plan_first()
            else:
                self._replan("next target", goal=self._target)
            self._fly_to_target()
        self._link.end()
        print(f"{self._now_s:8.2f} s  all targets held, plans because of the deck: {self._deck_plans}")

    @property
    def _target(self) -> dict[str, Any]:
        target: dict[str, Any] = self._bridge.targets[self._number]
        return target

    @property
    def _now(self) -> int:
        return int(self._rows[-1]["tick"])

    @property
    def _now_s(self) -> float:
        return self._now * self._link.tick_s

    def _ticks(self, time_s: float) -> int:
        return round(time_s / self._link.tick_s)

    def _read_telemetry(self) -> None:
        self._rows.append(self._link.next())

    def _fly_to_target(self) -> None:
        """Flies until the target is held, and plans again whenever that is needed."""
        while True:
            self._read_telemetry()
            has_arrived = self._now >= self._following.end_tick + self._ticks(self._target["hold_s"])
            lower_m = self._deck_is_lower_m()
            if self._replans and lower_m != 0:
                self._replan_below(lower_m)
            elif self._replans and self._now % 10 == 0 and math.hypot(*self._offset_m()) > MAX_DRIFT_M:
                self._replan("the vehicle has drifted")
            elif has_arrived and not self._following.leads_to_target:
                self._replan("the vehicle has stopped")
            elif has_arrived:
                error_m = self._target_error_m()
                if error_m <= self._target["end_effector"]["tolerance_m"]:
                    print(f"{self._now_s:8.2f} s  target {self._number + 1} held, {error_m:.3f} m off")
                    return
                self._replan("the target was missed", goal=self._target)

    def _plan_first(self) -> None:
        """Plans from the problem's start, where the vehicle hovers."""
        start = self._planner.start
        here: downwash.Columns = {name: np.zeros(1) for name in ("t_s", *downwash.ReferencePoint._fields)}
        here.update(x_m=np.array([start.x_m]), z_m=np.array([start.z_m]), arm_rad=np.array([start.arm_rad]))
        self._following = Command(self._now, start, here, "stop", self._link.tick_s)
        solution = self._planner.solve()
        if solution.status != "solved" or solution.plan is None:
            raise MissionFailed("no plan to the first target")
        from_tick = self._now + self._ticks(LEAD_IN_HOVER_S)
        self._link.send(Command(from_tick, start, solution.plan, "follow", self._link.tick_s))
        self._say("first plan", "follow", solution.plan)
        self._wait_until(from_tick)

    def _replan_below(self, lower_m: float) -> None:
        before_m = self._target["end_effector"]["z_m"]
        self._bridge.lower_deck(lower_m)
        has_moved = self._target["end_effector"]["z_m"] != before_m
        self._deck_plans += 1
        self._replan(
            f"the deck is {lower_m:.3f} m lower than believed",
            put=[self._bridge.deck],
            goal=self._target if has_moved else None,
        )

    def _replan(self, reason: str, put: list[dict[str, Any]] | None = None, goal: dict[str, Any] | None = None) -> None:
        """Plans from where the vehicle will be a moment later, and sends each answer: first how to stop, then better ones.

        The vehicle follows the last one that comes in time.
        """
        self._attempts += 1
        if self._attempts > MAX_ATTEMPTS:
            raise MissionFailed("too many plans for one target")
        # In a hover there is time, and more with each attempt.
        is_hovering = self._now >= self._following.end_tick
        lead_s = self._attempts * LEAD_IN_HOVER_S if is_hovering else LEAD_IN_FLIGHT_S
        from_tick = self._now + self._ticks(lead_s)
        start = self._predicted(from_tick)
        if self._following.leads_to_target:
            self._planner.adopt(self._following.plan)
        else:
            goal = self._target  # nothing is left of the way to it
        answer = self._planner.replan(
            start,
            from_tick - self._following.from_tick,
            put=put or [],
            goal=goal,
            max_iterations=self._attempts * ITERATIONS if self._link.is_lock_step else None,
            time_limit_s=None if self._link.is_lock_step else PLANNING_SHARE * lead_s,
            on_answer=lambda now: self._link.send(Command(from_tick, start, now.plan, now.advice, self._link.tick_s)),
        )
        self._say(reason, answer.advice, answer.plan)
        self._wait_until(from_tick)

    def _say(self, reason: str, advice: str, plan: downwash.Columns) -> None:
        duration_s, x_m, z_m = (plan[name][-1] for name in ("t_s", "x_m", "z_m"))
        leg = f"{advice}, {duration_s:.2f} s to ({x_m:.3f}, {z_m:.3f}) m"
        print(f"{self._now_s:8.2f} s  target {self._number + 1}, {reason}: {leg}", flush=True)

    def _wait_until(self, tick: int) -> None:
        while self._now < tick:
            self._read_telemetry()
        if self._link.accepted is not None and self._link.accepted.from_tick == tick:
            self._following = self._link.accepted

    def _modelled(self, tick: int) -> downwash.Start:
        """The vehicle at a tick, as the model has it."""
        following = self._following
        return self._planner.predicted(following.start, following.plan, max(0, tick - following.from_tick))

    def _predicted(self, tick: int) -> downwash.Start:
        """The vehicle at a tick to come: as the model has it, moved by how far the real one is off now."""
        start = self._modelled(tick)
        x_m, z_m = self._offset_m()
        return dataclasses.replace(start, x_m=start.x_m + x_m, z_m=start.z_m + z_m)

    def _offset_m(self) -> tuple[float, float]:
        """How far the vehicle is from where the model has it, on average over the last tenth of a second."""
        rows = self._rows[-10:]
        # The estimator is late. Within so short a time the vehicle moves almost evenly.
        seen = self._now - self._ticks(self._delay_s)
        last, first = self._modelled(seen), self._modelled(seen + 1 - len(rows))
        return (
            round(mean([row["x_m"] for row in rows]) - 0.5 * (first.x_m + last.x_m), 4),
            round(mean([row["z_m"] for row in rows]) - 0.5 * (first.z_m + last.z_m), 4),
        )

    def _deck_is_lower_m(self) -> float:
        """By how much the deck is lower than believed, once the range finder has said so often enough; else 0."""
        row = self._rows[-1]
        if row["range_up_m"] is not None:
            z_m = row["z_m"] + self._delay_s * row["vz_m_s"]  # the estimator is late
            lower_m = self._bridge.underside_m - z_m - row["range_up_m"]
            if abs(lower_m) < 0.3:  # else the beam has met something else
                self._lower_m.append(lower_m)
        if len(self._lower_m) < READINGS:
            return 0
        mean_m = mean(self._lower_m)
        error_m = math.sqrt(sum((each - mean_m) ** 2 for each in self._lower_m) / (READINGS * (READINGS - 1)))
        self._lower_m.clear()
        return round(mean_m, 4) if abs(mean_m) > max(0.02, 4 * error_m) else 0

    def _target_error_m(self) -> float:
        """How far the end effector was from the target, on average over the last second."""
        rows = self._rows[-self._ticks(1) :]
        angles = [row["pitch_rad"] + row["arm_rad"] for row in rows]
        x_m = mean([row["x_m"] + self._arm_m * math.cos(angle) for row, angle in zip(rows, angles)])
        z_m = mean([row["z_m"] - self._arm_m * math.sin(angle) for row, angle in zip(rows, angles)])
        return math.hypot(x_m - self._target["end_effector"]["x_m"], z_m - self._target["end_effector"]["z_m"])


def main(words: list[str]) -> int:
    replans = words[2:] != ["--no-replanning"]
    if len(words) != 2 and replans:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        problem = downwash.read_problem(words[0])
        Mission(VehicleLink(words[1]), problem, replans).run()
    except MissionFailed as error:
        print(f"mission: broken off: {error}", file=sys.stderr)
        return 1
    except FlightFailed as error:
        print(f"mission: {error}", file=sys.stderr)
        return 3
    except ConnectionLost as error:
        print(f"mission: contact with the vehicle is lost: {error}", file=sys.stderr)
        return 4
    except downwash.InputError as error:
        print(error, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("mission: interrupted; the vehicle flies its last reference to the end and hovers", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
