#!/usr/bin/env python3
"""Runs a campaign in shards on a real Slurm while things fail, and compares the merge with the run of one machine.

Usage: campaign_test.py DOWNWASH PROBLEMS [--long]

The short form has one node, 40 runs in 4 shards and one kill; GNU parallel runs them, too. The long form has two nodes, 2000 runs in 16 shards, tasks
whose time is over, kill -9 of programs, of batch scripts, of a slurmd and of the controller, a node whose disk is full,
and a clock that jumps by days.
"""

import argparse
import contextlib
import os
import pathlib
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

from cluster import Cluster, missing_programs

FAKE_TIME = next(pathlib.Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"), None)
# Columns that depend on time or on the machine; `checksum` is over them, too.
CHANGING = {"time", "time_to_first_solution", "first_certified_s", "runid", "id", "checksum", "memory"}
TABLES = ("progress", "flights", "certificates", "world_flights", "parameter_flights", "rejections", "errors")


def rows_of(folder: pathlib.Path) -> dict[tuple, dict]:
    """Every run with all its rows in all tables, by experiment, planner and seed."""
    runs: dict[tuple, dict] = {}
    with contextlib.closing(sqlite3.connect(f"file:{folder}/campaign.db?mode=ro", uri=True)) as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        database.row_factory = sqlite3.Row
        place = {}
        for row in database.execute("SELECT * FROM runs"):
            key = (row["experimentid"], row["plannerid"], row["seed"])
            assert key not in runs, f"{key} is there twice"
            place[row["id"]] = key
            runs[key] = {"runs": [kept(row)]}
            assert 0 <= row["time"] < 600, f"a run took {row['time']} s"
        for table in TABLES:
            for row in database.execute(f"SELECT * FROM {table} ORDER BY rowid"):
                runs[place[row["runid"]]].setdefault(table, []).append(kept(row))
    return runs


def kept(row: sqlite3.Row) -> tuple:
    return tuple(row[name] for name in row.keys() if name not in CHANGING)


class Campaign:
    def __init__(self, cluster: Cluster, program: pathlib.Path, problems: pathlib.Path, seeds: int, shards: int,
                 name: str = "trial", search: str = "max_iterations: 5\nstop_at_first_solution: true"):
        self.cluster = cluster
        self.program = program
        self.shards = shards
        self.folder = cluster.folder / name
        self.file = cluster.folder / f"{name}.yaml"
        self.file.write_text(
            f"schema: downwash/campaign/v1\nname: {name}\nproblems: [{problems}/open_air.yaml]\nvariants: [mp-arm, mp-arm-da]\n"
            f"seeds: {{first: 1, count: {seeds}}}\n{search}\nas_believed: true\njobs: 1\n")

    def run(self, *arguments, codes=(0,)) -> subprocess.CompletedProcess:
        result = subprocess.run([self.program, "bench", *map(str, arguments)], capture_output=True, text=True,
                                env=self.cluster.environment, check=False)
        assert result.returncode in codes, f"{arguments} ends with {result.returncode}: {result.stdout}{result.stderr}"
        return result

    def write_scripts(self):
        self.run("slurm", self.file, "--shards", self.shards, "--task-time", 1, "--out", self.folder)

    def change_script(self, old: str, new: str):
        script = self.folder / "shard.sh"
        text = script.read_text()
        assert old in text
        script.write_text(text.replace(old, new))

    def submit(self) -> str:
        """Submits everything. Gives the number of the job that merges."""
        result = self.cluster.run("bash", str(self.folder / "submit.sh"))
        assert result.returncode == 0, result.stderr
        return result.stdout.split("; job ")[1].split()[0]

    def processes(self, word: str) -> list[int]:
        """Those of tasks whose command line has a word."""
        found = []
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                line = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
                if word in line and (str(self.folder) in line or "slurm_script" in line):
                    found.append(int(entry.name))
        return found

    def finished_runs(self) -> int:
        """In the copies that the nodes have kept and on their own disks."""
        total = 0
        for file in self.cluster.folder.glob("**/shard-*/campaign.db"):
            with contextlib.suppress(sqlite3.Error), \
                    contextlib.closing(sqlite3.connect(f"file:{file}?mode=ro", uri=True)) as database:
                total += database.execute("SELECT count(*) FROM runs").fetchone()[0]
        return total

    def log(self, pattern: str) -> str:
        return "".join(file.read_text(errors="replace") for file in sorted((self.folder / "logs").glob(pattern)))

    def wait_for_merge(self, job: str, limit_s: float):
        def has_ended() -> bool:
            self.cluster.release_held()
            return self.cluster.has_ended(job)

        self.cluster.wait_until(has_ended, f"job {job} ends", limit_s)

    def shard_folders(self) -> list[pathlib.Path]:
        """Of the shards that have results, as merge.sh finds them."""
        return sorted(file.parent for file in (self.folder / "shards").glob("shard-*/campaign.db"))

    def check_equal(self, alone: pathlib.Path, folder: pathlib.Path | None = None):
        expected, found = rows_of(alone), rows_of((folder or self.folder) / "merged")
        different = [key for key in expected.keys() | found.keys() if expected.get(key) != found.get(key)]
        assert not different, f"{len(different)} of {len(expected)} runs differ: {different[0]}:\n" \
                              f"{expected.get(different[0])}\n{found.get(different[0])}"
        print(f"all {len(expected)} runs of the merge are those of one machine, row by row")

    def report_failure(self):
        print(self.cluster.logs()[-6000:], self.log("*")[-6000:], file=sys.stderr)


class Faults:
    """What fails in the long form, one thing after the other, while tasks run."""

    def __init__(self, campaign: Campaign, clock: pathlib.Path | None):
        self.campaign = campaign
        self.cluster = campaign.cluster
        self.clock = clock
        self.draw = random.Random(1)

    def kill_one(self, word: str):
        end = time.monotonic() + 60
        while time.monotonic() < end:
            for process in self.draw.sample(found := self.campaign.processes(word), len(found)):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
                    print(f"killed a process of `{word}` after {self.campaign.finished_runs()} runs", flush=True)
                    return
            self.cluster.release_held()
            time.sleep(0.2)
        raise TimeoutError(f"no process of `{word}`")

    def jump(self, offset: str):
        if self.clock is not None:
            self.clock.write_text(offset)

    def happen(self):
        self.kill_one("bench run")
        self.jump("+3d")
        time.sleep(2)
        self.kill_one("slurm_script")
        self.jump("-40d")
        time.sleep(1)
        self.cluster.kill("node1")
        self.kill_one("bench run")
        time.sleep(3)
        self.cluster.start_node("node1")
        self.jump("+1d")
        self.cluster.kill("slurmctld")
        time.sleep(3)
        self.cluster.start_controller()
        print("killed and started again: a slurmd and the controller", flush=True)
        self.kill_one("bench run")
        self.jump("+0d")


@contextlib.contextmanager
def small_disk(folder: pathlib.Path, kilobytes: int):
    """A file system of that size; none where it cannot be mounted."""
    folder.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k,mode=777", "tmpfs", folder],
                             capture_output=True, check=False).returncode == 0
    if not mounted:
        print("cannot mount a file system: no node has a full disk", flush=True)
    try:
        yield mounted
    finally:
        if mounted:
            subprocess.run(["umount", "--lazy", folder], check=False)


def short_form(folder: pathlib.Path, program: pathlib.Path, problems: pathlib.Path):
    with Cluster(folder, nodes=1) as cluster:
        campaign = Campaign(cluster, program, problems, seeds=20, shards=4)
        campaign.write_scripts()
        job = campaign.submit()
        cluster.wait_until(lambda: campaign.processes("bench run"), "a task runs")
        os.kill(campaign.processes("bench run")[0], signal.SIGKILL)
        campaign.run("run", campaign.file, "--out", folder / "alone", "--quiet")
        try:
            campaign.wait_for_merge(job, 60)
            assert "is put into the queue again" in campaign.log("shards-*"), "the killed task was not started again"
            campaign.check_equal(folder / "alone")
            check_parallel(campaign, folder)
            check_cancelled(cluster, program, problems)
        except BaseException:
            campaign.report_failure()
            raise


def check_cancelled(cluster: Cluster, program: pathlib.Path, problems: pathlib.Path):
    """Tasks that are cancelled do not put themselves into the queue again."""
    campaign = Campaign(cluster, program, problems, seeds=1, shards=1, name="cancelled", search="time_limit_s: 25")
    campaign.write_scripts()
    campaign.submit()
    cluster.wait_until(lambda: campaign.processes("bench run"), "a task runs")
    cluster.run("scancel", *cluster.ask("squeue", "-h", "-o", "%A").split())
    cluster.wait_until(lambda: not campaign.processes("bench run"), "the task has ended")
    cluster.wait_until(lambda: not cluster.ask("squeue", "-h", "-o", "%i"), "no job waits or runs")
    assert "is put into the queue again" not in campaign.log("shards-*"), "a cancelled task was started again"
    print("a cancelled task stays cancelled")


def check_parallel(campaign: Campaign, folder: pathlib.Path):
    """The same campaign with GNU parallel, twice: what is complete is not run again."""
    if shutil.which("parallel") is None:
        print("GNU parallel is not there: its scripts are not run", flush=True)
        return
    campaign.run("parallel", campaign.file, "--shards", 2, "--out", folder / "parallel")
    times = []
    for _ in range(2):
        result = subprocess.run(["bash", folder / "parallel" / "run.sh"], capture_output=True, text=True, check=False)
        assert result.returncode == 0, result.stdout + result.stderr
        with contextlib.closing(sqlite3.connect(folder / "parallel" / "merged" / "campaign.db")) as database:
            times.append(database.execute("SELECT sum(time) FROM runs").fetchone())
    assert times[0] == times[1], "runs were made twice"
    campaign.check_equal(folder / "alone", folder / "parallel")


def long_form(folder: pathlib.Path, program: pathlib.Path, problems: pathlib.Path):
    # 200 kB hold the first runs of a shard, not all of them.
    with small_disk(folder / "scratch.node2", 200) as has_full_disk, Cluster(folder, nodes=2, max_array_size=9) as cluster:
        (folder / "scratch.node1").mkdir()
        campaign = Campaign(cluster, program, problems, seeds=1000, shards=16)
        campaign.write_scripts()
        campaign.change_script("scratch=${DOWNWASH_SCRATCH", f"DOWNWASH_SCRATCH={folder}/scratch.$SLURMD_NODENAME\nscratch=${{DOWNWASH_SCRATCH")
        campaign.change_script("limit_s=30", "limit_s=2")
        clock = None
        if FAKE_TIME is not None:
            clock = folder / "clock"
            clock.write_text("+0d")
            wrapper = folder / "program.sh"
            wrapper.write_text(f"#!/bin/sh\nexec env LD_PRELOAD={FAKE_TIME} FAKETIME_DONT_FAKE_MONOTONIC=1 FAKETIME_NO_CACHE=1 "
                               f"FAKETIME_TIMESTAMP_FILE={clock} {program} \"$@\"\n")
            wrapper.chmod(0o755)
            campaign.change_script(str(program), str(wrapper))
        else:
            print("libfaketime is not there: no clock jumps", flush=True)
        begin = time.monotonic()
        try:
            job = campaign.submit()
            Faults(campaign, clock).happen()
            rounds = 1
            campaign.wait_for_merge(job, 400)
            while campaign.run("merge", folder / "trial", "--force", *campaign.shard_folders(),
                               codes=(0, 1)).returncode == 1 and rounds < 5:
                print(f"runs are missing after {time.monotonic() - begin:.0f} s: submitted again", flush=True)
                rounds += 1
                campaign.wait_for_merge(campaign.submit(), 200)
            print(f"merged after {time.monotonic() - begin:.0f} s and {rounds} submissions", flush=True)
            said = campaign.log("shards-*")
            assert "ended with 1: it is put into the queue again" in said, "no task came to the end of its time"
            assert "ended with 137: it is put into the queue again" in said, "no killed task was started again"
            assert not has_full_disk or "scratch.node2" in said, "no disk was full"
            campaign.run("run", campaign.file, "--out", folder / "alone", "--quiet", "--jobs", 1)
            campaign.check_equal(folder / "alone")
        except BaseException:
            campaign.report_failure()
            raise


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("problems", type=pathlib.Path, help="the folder of the shipped problems")
    parser.add_argument("--long", action="store_true")
    given = parser.parse_args()
    if missing := missing_programs():
        print(f"not there: {', '.join(missing)}; `./dev setup --all` installs Slurm")
        return 77  # CTest: skipped
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # the cluster is taken away, too
    # A socket's path is short, and every user of the machine reaches it.
    with tempfile.TemporaryDirectory(prefix="downwash-slurm-") as name:
        folder = pathlib.Path(name).resolve()
        folder.chmod(0o755)
        (long_form if given.long else short_form)(folder, given.program.resolve(), given.problems.resolve())
    return 0


if __name__ == "__main__":
    sys.exit(main())
