"""Runs `downwash solve` for a span of CPU time. On a shared machine wall time says little about a search."""

import json
import os
import pathlib
import signal
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
TICKS_PER_S = os.sysconf("SC_CLK_TCK")
POLL_S = 0.02
NO_LIMIT_S = 1e5
MOST_FIRST_S = 60


def used_s(pid):
    """CPU time that a process has used so far [s]."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_S


def has_ended(pid):
    return os.waitid(os.P_PID, pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None


def solve(problem, folder, seed, limit_s, options=()):
    """A search in one thread, and what came of it; its run is in the folder.

    @param limit_s: CPU time of the process; None for a search that stops at its first solution, or after a minute
    @return status, wall time of the search until its first solution (None without), CPU time of the process
    """
    command = [ROOT / "build/downwash", "solve", problem, "--seed", str(seed), "--threads", "1", "--quiet"]
    command += ["--out", folder, "--time-limit", str(NO_LIMIT_S), *options] + (["--stop-at-first"] if limit_s is None else [])
    planner = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    most_s = MOST_FIRST_S if limit_s is None else limit_s
    is_told = False
    while not has_ended(planner.pid):
        if not is_told and used_s(planner.pid) >= most_s:
            planner.send_signal(signal.SIGINT)  # it writes the best plan so far
            is_told = True
        time.sleep(POLL_S)
    _, status, used = os.wait4(planner.pid, 0)
    planner.returncode = os.waitstatus_to_exitcode(status)
    solution = json.loads((pathlib.Path(folder) / "solution.json").read_text(encoding="utf-8"))
    return {
        "status": solution["status"],
        "first_s": solution["planning"]["first_solution_wall_s"],
        "cpu_s": used.ru_utime + used.ru_stime,
    }
