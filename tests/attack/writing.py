"""Writing that cannot lose: kills, disks that are full or read-only, folders that vanish, and two writers at a time."""

import contextlib
import json
import pathlib
import shutil
import signal
import sqlite3
import subprocess
import time

from program import Finding
from tries import QUICK, Attack, Kind


def stored_runs(folder: pathlib.Path) -> dict[tuple, float]:
    """The time of each run that a file of results has, by experiment, planner and seed; none without a file."""
    if not (folder / "campaign.db").exists():
        return {}
    try:
        # Reading takes back what is half written, as the next program would.
        with contextlib.closing(sqlite3.connect(folder / "campaign.db", timeout=20)) as database:
            if database.execute("PRAGMA integrity_check").fetchone() != ("ok",):
                raise Finding("the file of results is damaged")
            if not database.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]:
                return {}
            return {row[:3]: row[3] for row in database.execute("SELECT experimentid, plannerid, seed, time FROM runs")}
    except sqlite3.Error as error:
        raise Finding(f"the file of results cannot be read: {error}") from None


class Campaigns(Attack):
    """SIGKILL while a campaign or a shard writes: no finished run is lost, none is made twice."""

    RUNS = 4000

    def prepare(self):
        self.problem("open_air")
        (self.folder / "campaign.yaml").write_text(
            "schema: downwash/campaign/v1\nname: small\nproblems: [open_air.yaml]\nvariants: [mp-arm]\njobs: 2\n"
            f"seeds: {{count: {self.RUNS}}}\nmax_iterations: 1\nstop_at_first_solution: true\n")
        self.seen: dict[str, dict] = {}

    def attempt(self, draw):
        name = draw.choice(["whole", "shard", "saved"])
        options = {"whole": [], "shard": ["--shard", "2/3"], "saved": ["--shard", "1/3", "--save", "kept"]}[name]
        self.program.interrupted("bench", "run", "campaign.yaml", "--out", name, "--resume", "--quiet", *options,
                                 signal_number=signal.SIGKILL, after_s=draw.uniform(0, 0.5))
        runs = stored_runs(self.folder / name)
        for key, time_s in self.seen.get(name, {}).items():
            if key not in runs:
                raise Finding(f"{name}: the run {key} is lost")
            if runs[key] != time_s:
                raise Finding(f"{name}: the run {key} was made twice")
        self.seen[name] = runs
        if draw.random() < 0.1 and runs:
            report = self.program.run("bench", "report", name, "--json", codes={0})
            if json.loads(report.stdout)["runs_done"] != len(runs):
                raise Finding(f"{name}: the report counts other runs than the file has")
        expected = self.RUNS if name == "whole" else self.RUNS // 3
        if len(runs) > 0.9 * expected:  # begun anew before there is nothing left to be killed
            shutil.rmtree(self.folder / name)
            shutil.rmtree(self.folder / "kept", ignore_errors=True)
            del self.seen[name]


class MapCaching(Attack):
    """SIGKILL while an aero map is built and cached: the next run comes to the same bytes."""

    def prepare(self):
        self.file = self.problem("bridge_inspection")
        self.program.run("solve", self.file, *QUICK, "--no-cache", "--out", "plain")
        self.expected = (self.folder / "plain" / "trajectory.csv").read_bytes()

    def attempt(self, draw):
        cache = self.folder / "cache"
        shutil.rmtree(cache, ignore_errors=True)
        for _ in range(draw.randrange(1, 4)):
            self.program.interrupted("solve", self.file, *QUICK, "--out", "killed", signal_number=signal.SIGKILL,
                                     after_s=draw.uniform(0, 1.5))
        self.program.run("solve", self.file, *QUICK, "--out", "after", codes={0, 1, 3})
        if (self.folder / "after" / "trajectory.csv").read_bytes() != self.expected:
            raise Finding("a run after a kill flies otherwise")
        shutil.rmtree(self.folder / "after")
        shutil.rmtree(self.folder / "killed", ignore_errors=True)


class Disks(Attack):
    """Full, read-only and vanishing folders, and two writers: an error that names the place, and nothing half written."""

    def prepare(self):
        self.problem("open_air")
        (self.folder / "campaign.yaml").write_text(
            "schema: downwash/campaign/v1\nname: small\nproblems: [open_air.yaml]\nvariants: [mp-arm]\njobs: 2\n"
            "seeds: {count: 20000}\nmax_iterations: 1\nstop_at_first_solution: true\n")
        self.disk = self.folder / "disk"

    @contextlib.contextmanager
    def mounted(self, *options: str):
        """A file system of its own; None where none can be mounted."""
        self.disk.mkdir(exist_ok=True)
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", ",".join(options), "tmpfs", self.disk], capture_output=True, check=False)
        try:
            yield self.disk if done.returncode == 0 else None
        finally:
            if done.returncode == 0:
                subprocess.run(["umount", "--lazy", self.disk], check=False)

    def bench(self, out: str, *options) -> list:
        return ["bench", "run", "campaign.yaml", "--quiet", "--resume", "--out", out, *options]

    def rejected(self, *arguments, names: str):
        """A command that ends with 2 and names a place."""
        result = self.program.run(*arguments, codes={2}, limit_s=120)
        if names not in result.stderr.decode(errors="replace"):
            raise Finding(f"{arguments} does not name {names}: {result.stderr.decode(errors='replace')[:500]}")

    def attempt(self, draw):
        draw.choice([self.full, self.full_for_solve, self.read_only, self.vanished, self.two_writers])(draw)

    def full(self, draw):
        with self.mounted(f"size={draw.randrange(120, 900)}k") as disk:
            if disk is None:
                return
            self.rejected(*self.bench("disk/results"), names="disk/results")
            runs = stored_runs(disk / "results")
            # What is there goes on where there is room.
            shutil.copytree(disk / "results", self.folder / "moved")
            if runs:
                self.program.run("bench", "report", "moved", "--csv", codes={0})
            shutil.rmtree(self.folder / "moved")

    def full_for_solve(self, draw):
        with self.mounted(f"size={draw.randrange(4, 120)}k") as disk:
            if disk is None:
                return
            self.rejected("solve", "open_air.yaml", *QUICK, "--out", "disk/run", names="disk/run")
            if (disk / "run").exists() and list((disk / "run").iterdir()):
                raise Finding(f"a full disk has parts of a run: {list((disk / 'run').iterdir())}")

    def read_only(self, draw):
        with self.mounted("size=4m") as disk:
            if disk is None:
                return
            self.program.interrupted(*self.bench("disk/results"), signal_number=draw.choice([signal.SIGKILL, signal.SIGTERM]),
                                     after_s=0.4)
            subprocess.run(["mount", "-o", "remount,ro", disk], check=True)
            self.rejected(*self.bench("disk/results"), names="disk/results")
            self.rejected("solve", "open_air.yaml", *QUICK, "--out", "disk/run", names="disk/run")

    def vanished(self, draw):
        arguments = self.bench("gone")
        process = self.program.start(*arguments)
        time.sleep(draw.uniform(0.3, 0.8))
        if draw.random() < 0.5:
            shutil.rmtree(self.folder / "gone", ignore_errors=True)
        else:
            (self.folder / "gone" / "campaign.db").unlink(missing_ok=True)
        out, err = self.program.end_of(process, arguments, 30)
        self.program.judged(arguments, process.returncode, out, err, {2})
        if b"gone" not in err:
            raise Finding(f"a vanished folder is not named: {err[:500]!r}")
        shutil.rmtree(self.folder / "gone", ignore_errors=True)

    def two_writers(self, draw):
        arguments = self.bench("shared")
        first = self.program.start(*arguments)
        time.sleep(0.3 + draw.uniform(0, 0.2))
        self.rejected(*arguments, names="another program is running the campaign in shared")
        first.send_signal(signal.SIGTERM)
        self.program.end_of(first, arguments, 30)
        if not stored_runs(self.folder / "shared"):
            raise Finding("the first writer has stored nothing")
        shutil.rmtree(self.folder / "shared")


KINDS = [
    Kind("campaigns", 400, Campaigns),
    Kind("maps", 200, MapCaching),
    Kind("disks", 100, Disks),
]
