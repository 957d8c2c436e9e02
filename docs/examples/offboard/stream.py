#!/usr/bin/env python3
"""Plans a flight and streams it to a vehicle under PX4, as MAVLink over UDP: stream.cpp, decision by decision.

Usage: stream.py PROBLEM.yaml
  --lower OBSTACLE METRES   it turns out lower in flight: the streamer plans again
  --iterations N            of each search, which makes a mission repeatable; default: 60 s before a flight, 1.2 s in flight
  --instance N              adds N to both ports: 14540, on which it listens, and 14580, to which it sends
  --stop-after S            stops sending that long after offboard mode began, as if it had crashed
Exit codes: 0 the vehicle hovers at the goal, 1 it does not, 2 bad input, 3 no vehicle answers.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import contextlib
import json
import math
import pathlib
import socket
import sys
import tempfile
import time
from typing import Any

import downwash
import mavlink
import numpy as np

SETPOINTS_S = 1.0  # before PX4 enters offboard mode
LOSS_TIMEOUT_S = 0.5  # COM_OF_LOSS_T: so long PX4 waits for a set-point; its default is 1 s
MAX_ACCELERATION_M_S2 = 3.0  # MPC_ACC_HOR
STOP_DELAY_S = 0.6  # until PX4 brakes in Hold, as it reckons

SIGHT_M = 1.5  # at which the obstacle is seen, from the multirotor's centre of mass
LEAD_S = 3.0  # from what is seen to the first tick of the new plan
PLANNING_SHARE = 0.4  # of the lead, for the search; then the plan is looked at
BETWEEN_MOMENTS_S = 0.5  # of a plan at which it is looked at
MAX_ERROR_M = 0.04  # of PX4's loops along a plan
MIN_CLEARANCE_M = 0.1  # of what is flown in silence
MIN_SPEED_M_S = 0.1
REQUEST_PERIOD_S, HEARTBEAT_PERIOD_S = 0.5, 1.0
ON_GROUND_S = 60  # for the plan of a flight
MAX_SILENCE_S = 10  # of the vehicle

OFFBOARD, HOLD = 6 << 16, 4 << 16 | 3 << 24  # PX4's custom_mode
DO_SET_MODE, DO_SET_ACTUATOR = 176, 187
EMERGENCY = 6


def read_px4_problem(file: str) -> downwash.Problem:
    problem = downwash.read_problem(file)
    if problem["robot.controller.type"] != "px4-cascade":
        raise downwash.InputError("robot.controller.type: expected px4-cascade (downwash margins --design --law)")
    return problem


def obstacle_in(problem: downwash.Problem, name: str) -> dict[str, Any]:
    """The obstacle of that name, which has to be a box."""
    for obstacle in problem["environment.obstacles"]:
        if obstacle["name"] == name and "box" in obstacle:
            return dict(obstacle)
    raise downwash.InputError(f"environment.obstacles has no box called '{name}'")


def with_obstacle(problem: downwash.Problem, obstacle: dict[str, Any]) -> downwash.Problem:
    """The problem with another obstacle of that name."""
    obstacles = [obstacle if each["name"] == obstacle["name"] else each for each in problem["environment.obstacles"]]
    return problem.replace({"environment.obstacles": obstacles})


def distance_m(at_m: tuple[float, ...], box: dict[str, Any]) -> float:
    """From a place to a box whose edges are along the axes."""
    beyond_m = [max(0.0, abs(at - center) - 0.5 * size) for at, center, size in zip(at_m, box["center_m"], box["size_m"])]
    return math.sqrt(sum(each * each for each in beyond_m))


def joined(first: downwash.Columns, tick: int, rest: downwash.Columns, tick_s: float) -> downwash.Columns:
    """The beginning of a plan, and from a tick on another one."""
    before = np.rint(first["t_s"] / tick_s) < tick
    columns = {name: np.concatenate([first[name][before], rest[name]]) for name in first if name != "t_s"}
    return {"t_s": np.concatenate([first["t_s"][before], rest["t_s"] + tick * tick_s]), **columns}


def as_start(vehicle: Any) -> dict[str, Any]:
    """A vehicle in flight (a downwash.SpaceStart) as a start in a problem file."""
    reference = list(vehicle.reference.values())  # position, velocity and acceleration of each axis
    axes = len(reference) // 3
    return {
        "x_m": vehicle.x_m,
        "y_m": vehicle.y_m,
        "z_m": vehicle.z_m,
        "attitude": [vehicle.qw, vehicle.qx, vehicle.qy, vehicle.qz],
        "joints_deg": [math.degrees(angle) for angle in vehicle.joints_rad],
        "velocity_m_s": [vehicle.vx_m_s, vehicle.vy_m_s, vehicle.vz_m_s],
        "body_rates_rad_s": [vehicle.wx_rad_s, vehicle.wy_rad_s, vehicle.wz_rad_s],
        "joint_rates_rad_s": list(vehicle.joint_rates_rad_s),
        "reference": {
            "position": reference[:axes],
            "velocity": reference[axes : 2 * axes],
            "acceleration": reference[2 * axes :],
        },
        "rotor_thrust_n": list(vehicle.rotor_thrust_n),
        "controller_memory": list(vehicle.controller_memory),
    }


def ned(x: float, y: float, z: float) -> tuple[float, float, float]:
    """A vector of the world (x forward, y left, z up) in PX4's local frame, or the other way round. x points north."""
    return x, -y, -z


class Streamer:
    """Answers each telemetry of the vehicle, whose clock is the only one, with a set-point."""

    def __init__(self, drawing: downwash.Problem, lower: tuple[str, float] | None, iterations: int | None) -> None:
        self._drawing = drawing
        self._iterations = iterations
        self._lower: dict[str, Any] | None = None
        if lower is not None:
            self._lower = obstacle_in(drawing, lower[0])
            self._lower["box"]["center_m"][2] -= lower[1]
            self._lower_m = lower[1]
        self._limits_deg = [link.get("limits_deg") for link in drawing["robot.arm.links"]] if drawing.joints else []
        self._pool = concurrent.futures.ThreadPoolExecutor(1)
        self._replan: concurrent.futures.Future[downwash.Answer] | None = None
        self._phase = "offering"  # then flying, stopping and over
        self.has_arrived = False
        self.flown_s = 0.0  # since offboard mode began
        self._now_s = 0.0  # the vehicle's clock
        self._at_m: tuple[float, ...] = (0, 0, 0)
        self._mode = 0
        self._since_s: float | None = None  # of the phase
        self._next_request_s = self._next_heartbeat_s = 0.0
        self._tick = self._new_plan_from = self._sequence = 0
        self._leads_to_goal = True
        self._knows = False  # that the obstacle is lower
        self._max_distance_m = 0.0

    def is_over(self) -> bool:
        return self._phase == "over"

    def plan(self) -> bool:
        """Plans from the start to the goals. Returns whether there is a plan that is safe when the link falls silent."""
        speed_m_s = self._drawing["motion.max_speed_m_s"]
        while speed_m_s > MIN_SPEED_M_S:
            self._believed = self._drawing.replace({"motion.max_speed_m_s": speed_m_s})
            self._planner = downwash.Planner(self._believed, threads=1, stop_at_first=True)
            solution = self._planner.solve()
            if solution.status != "solved" or solution.plan is None:
                self._say("no plan")
                return False
            self._plan = solution.plan
            self._say(f"a plan of {self._plan['t_s'][-1]:.2f} s at up to {speed_m_s:.3f} m/s")
            self._start = self._planner.start
            objection = self._objection_to(self._plan, 0)
            if objection is None:
                self._say("it is safe wherever the link may fall silent")
                return True
            self._say(objection)
            speed_m_s /= 2
        return False

    def _objection_to(self, plan: downwash.Columns, begin: int) -> str | None:
        """Why a plan is not to be flown, from a tick on."""
        for tick in range(begin, self._ticks(plan["t_s"][-1]), self._ticks(BETWEEN_MOMENTS_S)):
            moment_s = tick * self._planner.tick_s
            there = self._planner.predicted(self._start, plan, tick)
            wanted = self._reference(plan, tick)
            off_m = math.dist((there.x_m, there.y_m, there.z_m), [wanted[f"{axis}_m"] for axis in "xyz"])
            if off_m > MAX_ERROR_M:
                return f"PX4 would be {off_m:.3f} m off at {moment_s:.2f} s"
            silent = self._flown_in_silence(plan, tick)
            goal = {"configuration": self._configuration_at_end(silent), "hold_s": 1}
            problem = self._believed.replace({"start": as_start(there), "goal": goal})
            flight = downwash.execute(problem, self._as_solution(silent, problem))
            clearance_m = math.inf if flight.min_clearance_m is None else flight.min_clearance_m
            if flight.outcome != "ok" or clearance_m < MIN_CLEARANCE_M:
                return f"silence at {moment_s:.2f} s would lead too close to an obstacle"
        return None

    def _configuration_at_end(self, plan: downwash.Columns) -> dict[str, Any]:
        """Where a plan ends, as a goal in a problem file."""
        at: dict[str, Any] = {name: float(plan[name][-1]) for name in ("x_m", "y_m", "z_m")}
        at["yaw_deg"] = math.degrees(plan["yaw_rad"][-1])
        at["joints_deg"] = [math.degrees(plan[f"joint_{i + 1}_rad"][-1]) for i in range(len(self._limits_deg))]
        return at

    def _flown_in_silence(self, plan: downwash.Columns, tick: int) -> downwash.Columns:
        """What PX4 makes of silence from a tick on: it holds on to the last set-point, which carries it on, and stops in Hold."""
        last = self._reference(plan, tick)
        then = {name: value if is_position(name) else 0.0 for name, value in last.items()}
        for axis in "xyz":
            self._hold_on(last, then, axis)
        speed_m_s = math.hypot(*(then[f"v{axis}_m_s"] for axis in "xyz"))
        duration_s = speed_m_s / MAX_ACCELERATION_M_S2 + 2 * STOP_DELAY_S  # evenly slower, to where PX4 stops
        end = {name: value if is_position(name) else 0.0 for name, value in then.items()}
        for axis in "xyz":
            end[f"{axis}_m"] += 0.5 * duration_s * then[f"v{axis}_m_s"]
        tick_s = self._planner.tick_s
        wait_ticks, stop_ticks = self._ticks(LOSS_TIMEOUT_S), self._ticks(duration_s)
        rest = {name: np.array([point[name] for point in (last, then, end)]) for name in last}
        rest["t_s"] = np.array([0, wait_ticks, wait_ticks + stop_ticks]) * tick_s
        return rest

    def _hold_on(self, last: dict[str, float], then: dict[str, float], axis: str) -> None:
        """Position and velocity of PX4's outer loops after a while with a set-point that no longer changes."""
        law = "robot.controller."
        position_p = self._believed[law + ("height_p_1_s" if axis == "z" else "position_p_1_s")]
        velocity_p = self._believed[law + ("vertical_velocity.kp" if axis == "z" else "velocity.kp")]
        position, velocity = last[f"{axis}_m"], last[f"v{axis}_m_s"]
        t_s = 0.0
        while t_s < LOSS_TIMEOUT_S:
            wanted = last[f"v{axis}_m_s"] + position_p * (last[f"{axis}_m"] - position)
            velocity += self._planner.tick_s * (last[f"a{axis}_m_s2"] + velocity_p * (wanted - velocity))
            position += self._planner.tick_s * velocity
            t_s += self._planner.tick_s
        then[f"{axis}_m"], then[f"v{axis}_m_s"] = position, velocity

    def greeting(self) -> bytes:
        """Says "here I am": what a vehicle hears first."""
        return self._frame("HEARTBEAT", type=18, autopilot=8, system_status=4, mavlink_version=3)

    def answer(self, datagram: bytes) -> bytes:
        """The answer to a datagram from the vehicle: a set-point and what goes with it. Empty if it has no position."""
        has_position = False
        for name, message in mavlink.frames(datagram):
            if name == "HEARTBEAT":
                self._mode = message["custom_mode"]
                if message["system_status"] == EMERGENCY:
                    self._end("the vehicle is lost")
            elif name == "LOCAL_POSITION_NED":
                has_position = True
                self._now_s = 1e-3 * message["time_boot_ms"]
                self._at_m = ned(message["x"], message["y"], message["z"])
        if not has_position or self.is_over():
            return b""
        self._proceed()
        return b"" if self.is_over() else self._frames()

    def _proceed(self) -> None:
        is_offboard = self._mode == OFFBOARD
        if self._since_s is None:
            self._since_s = self._now_s
            self._next_request_s = self._now_s + SETPOINTS_S + 0.1  # the first set-points may be late
        if self._phase == "offering" and is_offboard:
            self._say("offboard")
            self._phase = "flying"
            self._since_s = self._now_s
        if self._phase == "stopping" and not is_offboard:
            self.has_arrived = self._leads_to_goal
            self._end(f"hold, at most {self._max_distance_m:.3f} m from the plan so far")
        elif self._phase == "flying" and not is_offboard:
            self._end("the vehicle holds, since set-points did not come")
        elif self._phase != "offering":
            self._tick = self._ticks(self._now_s - self._since_s)
            self.flown_s = self._tick * self._planner.tick_s
            self._take_new_plan()
            wanted = self._reference(self._plan, self._tick)
            off_m = math.dist(self._at_m, [wanted[f"{axis}_m"] for axis in "xyz"])
            self._max_distance_m = max(self._max_distance_m, off_m)
            self._look_around()
            end = self._ticks(self._plan["t_s"][-1]) + self._ticks(self._hold_s())
            if self._tick >= end and self._phase == "flying" and self._replan is None:
                self._phase = "stopping"

    def _look_around(self) -> None:
        """A sensor sees that an obstacle is lower, and a new plan is made while the old one is flown."""
        if self._lower is None or self._knows:
            return
        if distance_m(self._at_m, self._lower["box"]) < SIGHT_M:
            self._say(f"{self._lower['name']} is {self._lower_m:.3f} m lower than on the drawing")
            self._knows = True
            self._believed = with_obstacle(self._believed, self._lower)
            self._new_plan_from = self._tick + self._ticks(LEAD_S)
            self._replan = self._pool.submit(self._make_new_plan)

    def _make_new_plan(self) -> downwash.Answer:
        """What to fly from the next plan's tick on: the best answer to which there is no objection. A stop is always one."""
        answers: list[downwash.Answer] = []  # each better than the one before; the first is a stop
        tick = self._new_plan_from
        start = self._planner.predicted(self._start, self._plan, tick)
        limit: dict[str, Any] = {"time_limit_s": PLANNING_SHARE * LEAD_S}
        if self._iterations is not None:
            limit = {"max_iterations": self._iterations}
        self._planner.replan(start, tick, put=[self._lower], on_answer=answers.append, **limit)
        while answers[-1].advice in ("keep", "follow") and len(answers) > 1:
            whole = joined(self._plan, tick, answers[-1].plan, self._planner.tick_s)
            if self._objection_to(whole, tick) is None:
                break
            answers.pop()
        return answers[-1]

    def _take_new_plan(self) -> None:
        if self._replan is None or self._tick < self._new_plan_from:
            return
        answer = self._replan.result()
        self._replan = None
        self._plan = joined(self._plan, self._new_plan_from, answer.plan, self._planner.tick_s)
        self._leads_to_goal = answer.advice in ("keep", "follow")
        end = ", ".join(f"{answer.plan[name][-1]:.3f}" for name in ("x_m", "y_m", "z_m"))
        self._say(f"{answer.advice}: {answer.plan['t_s'][-1]:.2f} s to ({end}) m")

    def _frames(self) -> bytes:
        """What is sent now."""
        datagram = b""
        if self._now_s >= self._next_heartbeat_s:
            datagram += self.greeting()
            self._next_heartbeat_s = self._now_s + HEARTBEAT_PERIOD_S
        if self._phase != "flying" and self._now_s >= self._next_request_s:
            mode = OFFBOARD if self._phase == "offering" else HOLD
            datagram += self._command(DO_SET_MODE, [1, mode >> 16 & 0xFF, mode >> 24])
            self._next_request_s = self._now_s + REQUEST_PERIOD_S
        at = self._reference(self._plan, 0 if self._phase == "offering" else self._tick)
        joints = [self._actuator(at[f"joint_{i + 1}_rad"], limits) for i, limits in enumerate(self._limits_deg)]
        datagram += self._command(DO_SET_ACTUATOR, joints + [math.nan] * (6 - len(joints)))
        vectors = {
            **dict(zip(("x", "y", "z"), ned(at["x_m"], at["y_m"], at["z_m"]))),
            **dict(zip(("vx", "vy", "vz"), ned(at["vx_m_s"], at["vy_m_s"], at["vz_m_s"]))),
            **dict(zip(("afx", "afy", "afz"), ned(at["ax_m_s2"], at["ay_m_s2"], at["az_m_s2"]))),
        }
        return datagram + self._frame(
            "SET_POSITION_TARGET_LOCAL_NED",
            time_boot_ms=round(1e3 * self._now_s),
            **vectors,
            yaw=math.remainder(-at["yaw_rad"], 2 * math.pi),
            yaw_rate=-at["yaw_rate_rad_s"],
            target_system=1,
            target_component=1,
            coordinate_frame=1,
        )

    @staticmethod
    def _actuator(angle_rad: float, limits_deg: list[float] | None) -> float:
        """An angle as MAV_CMD_DO_SET_ACTUATOR: -1 is the joint's lower limit, 1 its upper one."""
        low, high = (-math.pi, math.pi) if limits_deg is None else map(math.radians, limits_deg)
        return 2 * (angle_rad - low) / (high - low) - 1

    def _command(self, number: int, params: list[float]) -> bytes:
        values = {f"param{i + 1}": value for i, value in enumerate(params)}
        return self._frame("COMMAND_LONG", command=number, **values, target_system=1, target_component=1)

    def _frame(self, name: str, **values: Any) -> bytes:
        self._sequence += 1
        return mavlink.frame(self._sequence - 1, 1, 191, name, **values)

    def _reference(self, plan: downwash.Columns, tick: int) -> dict[str, float]:
        return dict(self._planner.reference_of(plan, tick))

    def _hold_s(self) -> float:
        goal = self._believed["goal"]
        return float((goal[-1] if isinstance(goal, list) else goal)["hold_s"])

    def _ticks(self, time_s: float) -> int:
        return round(time_s / self._planner.tick_s)

    @staticmethod
    def _as_solution(plan: downwash.Columns, problem: downwash.Problem) -> downwash.Solution:
        """A plan as a solution of a problem, by way of a file."""
        knots = [dict(zip(plan, map(float, row))) for row in zip(*plan.values())]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "solution.json"
            file.write_text(json.dumps({"schema": "downwash/solution/v1", "plan": {"reference": knots}}), encoding="utf-8")
            return downwash.read_solution(file, problem)

    def _end(self, why: str) -> None:
        if not self.is_over():
            self._say(why)
            self._phase = "over"

    def _say(self, text: str) -> None:
        print(f"{self._now_s:8.2f} s  {text}", flush=True)


def is_position(name: str) -> bool:
    """Whether a number of a knot is the position of an axis."""
    return name in ("x_m", "y_m", "z_m", "yaw_rad") or (name.startswith("joint_") and name.count("_") == 2)


def send(link: socket.socket, datagram: bytes) -> None:
    with contextlib.suppress(ConnectionRefusedError):  # what nobody listens to is lost
        link.send(datagram)


def receive(link: socket.socket, timeout_s: float) -> bytes:
    """The next datagram; empty if none comes in time, or nobody is there."""
    link.settimeout(timeout_s)
    try:
        return link.recv(65536)
    except (socket.timeout, ConnectionRefusedError):
        return b""


def stream(streamer: Streamer, instance: int, stop_after_s: float) -> int:
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    link.bind(("127.0.0.1", 14540 + instance))
    link.connect(("127.0.0.1", 14580 + instance))
    deadline_s = time.monotonic() + MAX_SILENCE_S
    datagram = b""
    while not datagram:
        if time.monotonic() > deadline_s:
            print("no vehicle answers", file=sys.stderr)
            return 3
        send(link, streamer.greeting())
        datagram = receive(link, 0.2)
        time.sleep(0.02)
    while True:
        if answer := streamer.answer(datagram):
            send(link, answer)
        if streamer.is_over() or streamer.flown_s >= stop_after_s:
            return 0 if streamer.has_arrived else 1
        datagram = receive(link, MAX_SILENCE_S)
        if not datagram:
            print("the vehicle is silent", file=sys.stderr)
            return 3


def main() -> int:
    words = argparse.ArgumentParser(description="Streams a plan to a vehicle under PX4.")
    words.add_argument("problem")
    words.add_argument("--lower", nargs=2, metavar=("OBSTACLE", "METRES"))
    words.add_argument("--iterations", type=int)
    words.add_argument("--instance", type=int, default=0)
    words.add_argument("--stop-after", type=float, default=math.inf)
    given = words.parse_args()
    try:
        limit = None if given.iterations is not None else ON_GROUND_S
        drawing = read_px4_problem(given.problem)
        drawing = drawing.replace({"planner.max_iterations": given.iterations, "planner.time_limit_s": limit})
        lower = None if given.lower is None else (given.lower[0], float(given.lower[1]))
        streamer = Streamer(drawing, lower, given.iterations)
        return stream(streamer, given.instance, given.stop_after) if streamer.plan() else 1
    except (downwash.InputError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
