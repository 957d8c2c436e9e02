#!/usr/bin/python3
"""Compares a run with logs of an hour in which its flight stands, and writes bench/results/flight_logs.md. A few minutes.

Each log holds position, attitude, rates and motors at the given rate; before and after the flight the vehicle flies in circles.
Usage: bench/flight_logs.py [--rate HZ] [--hours H]
"""

import argparse
import array
import csv
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROBLEM = ROOT / "problems/space/around_a_girder.yaml"
PLAN = ROOT / "problems/space/around_a_girder.json"
MOST_S, MOST_BYTES = 10, 10**9


def flight_of(run):
    """Rows of trajectory.csv as numbers by name."""
    with open(run / "trajectory.csv", encoding="ascii", newline="") as file:
        return [{name: float(cell) for name, cell in row.items() if cell} for row in csv.DictReader(file)]


def moments(rows, rate_hz, hours):
    """Time, place, attitude, rates and thrusts for the length of the log; the flight begins in its middle."""
    start_s, tick_s = 1800 * hours, rows[1]["t_s"] - rows[0]["t_s"]
    rotors = [name for name in rows[0] if name.endswith("_cmd_n")]
    for i in range(int(3600 * hours * rate_hz)):
        t = i / rate_hz
        at = (t - start_s) / tick_s
        row = rows[min(max(int(at), 0), len(rows) - 1)]
        place = [row["x_m"], row["y_m"], row["z_m"]]
        if not 0 <= at < len(rows):
            angle = 0.31 * t
            place = [place[0] + 3 * math.sin(angle), place[1] + 2 * math.sin(0.77 * angle), place[2] + 1 + math.sin(1.3 * angle)]
        yield t, place, [row[name] for name in ("qw", "qx", "qy", "qz")], [
            row[name] for name in ("wx_rad_s", "wy_rad_s", "wz_rad_s")
        ], [row[name] for name in rotors]


def write_ulog(file, all_moments):
    def message(kind, body):
        file.write(struct.pack("<HB", len(body), ord(kind)) + body)

    file.write(b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0))
    message("B", bytes(40))
    formats = {
        "vehicle_local_position": "uint64_t timestamp;float x;float y;float z;",
        "vehicle_attitude": "uint64_t timestamp;float[4] q;",
        "vehicle_angular_velocity": "uint64_t timestamp;float[3] xyz;",
        "actuator_motors": "uint64_t timestamp;float[12] control;",
    }
    for i, (name, fields) in enumerate(formats.items()):
        message("F", f"{name}:{fields}".encode())
        message("A", struct.pack("<BH", 0, i) + name.encode())
    for t, (x, y, z), (w, qx, qy, qz), (p, q, r), rotors in all_moments:
        us = round(1e6 * t)
        message("D", struct.pack("<HQ3f", 0, us, x, -y, -z))
        message("D", struct.pack("<HQ4f", 1, us, w, qx, -qy, -qz))
        message("D", struct.pack("<HQ3f", 2, us, p, -q, -r))
        motors = [n / 20 for n in rotors] + [math.nan] * (12 - len(rotors))
        message("D", struct.pack("<HQ", 3, us) + array.array("f", motors).tobytes())


def write_csv(file, all_moments):
    file.write(b"t_s,x,y,z,qw,qx,qy,qz,wx,wy,wz," + b",".join(b"rotor_%d" % (i + 1) for i in range(6)) + b"\n")
    for t, place, attitude, rates, rotors in all_moments:
        file.write((",".join(f"{n:.9g}" for n in [t, *place, *attitude, *rates, *rotors[:6]]) + "\n").encode())


def measured(command):
    """Processor time [s] and most memory [byte] of a command."""
    pid = os.fork()
    if pid == 0:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.execv(command[0], [str(word) for word in command])
    _, status, used = os.wait4(pid, 0)
    if status != 0:
        raise SystemExit(f"bench/flight_logs.py: {' '.join(map(str, command))} failed")
    return used.ru_utime + used.ru_stime, used.ru_maxrss * 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rate", type=float, default=250)
    parser.add_argument("--hours", type=float, default=1)
    parser.add_argument("--markdown", default=str(ROOT / "bench/results/flight_logs.md"))
    given = parser.parse_args()
    program = ROOT / "build/downwash"
    lines = []
    is_kept = True
    with tempfile.TemporaryDirectory() as work:
        run = pathlib.Path(work) / "run"
        subprocess.run([program, "execute", PROBLEM, "--plan", PLAN, "--out", run, "--quiet"], check=True, stdout=subprocess.DEVNULL)
        rows = flight_of(run)
        for name, write in (("flight.ulg", write_ulog), ("flight.csv", write_csv)):
            log = pathlib.Path(work) / name
            with open(log, "wb") as file:
                write(file, moments(rows, given.rate, given.hours))
            for worlds in (0, 32):
                command = [program, "compare", run, log, "--threads", "1", "--quiet", "--envelope-worlds", worlds]
                seconds, most_bytes = measured(command)
                is_kept = is_kept and (worlds > 0 or seconds <= MOST_S) and most_bytes <= MOST_BYTES
                lines.append(
                    f"| {name[-3:]} | {log.stat().st_size / 1e6:.0f} MB | {worlds} | {seconds:.1f} s | {most_bytes / 1e6:.0f} MB |"
                )
            log.unlink()
    text = "\n".join(
        [
            "# Flight logs of an hour",
            "",
            f"`downwash compare` with the shipped plan of `around_a_girder` and a log of {given.hours:g} h at {given.rate:g} Hz, in whose middle its flight stands. "
            "Processor time of the process in one thread, and the most memory that it had. `bench/flight_logs.py` measures it.",
            "",
            "| log | size | worlds of the envelope | processor time | memory |",
            "| --- | --- | --- | --- | --- |",
            *lines,
            "",
            "Worlds are flights of their own: they take their time whatever the length of the log.",
            "",
        ]
    )
    pathlib.Path(given.markdown).write_text(text, encoding="utf-8")
    print(text)
    return 0 if is_kept else 1


if __name__ == "__main__":
    sys.exit(main())
