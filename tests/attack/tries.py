"""What is tried. Each attack works in the folder of its program, and attempt() draws one try."""

import dataclasses
import json
import math
import pathlib
import random
import re
import shutil
import signal
import time
import xml.dom.minidom

import foreign
import mutations
from program import GOOD_CODES, Finding, Program

QUICK = ["--max-iterations", "10", "--time-limit", "5", "--quiet"]


class Attack:
    def __init__(self, program: Program, problems: pathlib.Path):
        self.program = program
        self.problems = problems
        self.folder = program.folder
        self.prepare()

    def prepare(self):
        """What all tries need."""

    def attempt(self, draw: random.Random):
        raise NotImplementedError

    def keep(self, folder: pathlib.Path):
        shutil.copytree(self.folder, folder, dirs_exist_ok=True)

    def problem(self, name: str, **replacements: str) -> pathlib.Path:
        """A shipped problem in the nominal world, in this folder, with some of its lines replaced."""
        text = (self.problems / f"{name}.yaml").read_text()
        for what in ("robots", "meshes", "maps"):
            text = re.sub(rf"(robot: |file: ){what}/", rf"\1{self.problems}/{what}/", text)
        text = text.replace("uncertainty: {}", "uncertainty: none")
        for key, value in replacements.items():
            line = f"{key}: {value}"
            text = re.sub(rf"^( *){key}:.*$", lambda found, line=line: found[1] + line, text, flags=re.MULTILINE)
        file = self.folder / f"{name}.yaml"
        file.write_text(text)
        return file

    def solved(self, out: str) -> pathlib.Path:
        """A run of the bridge in a folder of that name."""
        self.program.run("solve", self.problem("bridge_inspection"), *QUICK, "--out", out)
        return self.folder / out


def finite(text: str, what: str):
    """The JSON of a text, all of whose numbers are finite."""
    def reject(word: str):
        raise Finding(f"{what} holds {word}")

    try:
        return json.loads(text, parse_constant=reject)
    except ValueError as error:
        raise Finding(f"{what} is not JSON: {error}") from None


def check_honest(folder: pathlib.Path, code: int):
    """What a run says of itself agrees with its exit code, and its numbers are finite."""
    solution = finite((folder / "solution.json").read_text(), "solution.json")
    is_good = solution["status"] == "solved" and solution["execution"]["outcome"] == "ok"
    if is_good != (code == 0) or (code == 1) != (solution["status"] != "solved"):
        raise Finding(f"exit code {code} for a plan that is {solution['status']}")
    for row in (folder / "trajectory.csv").read_text().split("\n")[1:]:
        if re.search(r"nan|inf", row, re.IGNORECASE):
            raise Finding(f"trajectory.csv holds {row[:80]}")


class Problems(Attack):
    """Damaged problems and robots: read, or refused with the file's name."""

    def attempt(self, draw):
        name = draw.choice(sorted(file.stem for file in self.problems.glob("*.yaml")))
        file = self.problem(name)
        robot = self.folder / "robot.yaml"
        robot.write_bytes((self.problems / "robots" / draw.choice(["ars_lrm.yaml", "ars_lrm_ideal.yaml"])).read_bytes())
        file.write_text(re.sub(r"^robot:.*$", "robot: robot.yaml", file.read_text(), flags=re.MULTILINE))
        victim = draw.choice([file, file, robot])
        for _ in range(draw.choice([1, 1, 2, 3])):
            victim.write_bytes(mutations.damaged(victim.read_bytes(), draw))
        checked = self.program.run("check", file, codes={0, 2})
        if checked.returncode == 2:
            said = checked.stderr.decode(errors="replace")
            # A damaged name of a robot's file may lead to another file, which is named then.
            if not any(name in said for name in (file.name, robot.name, "/etc/passwd")):
                raise Finding(f"an error does not name its file: {said[:500]}")
            return
        shutil.rmtree(self.folder / "run", ignore_errors=True)
        run = self.program.run("solve", file, *QUICK, "--threads", "1", "--out", "run", limit_s=120)
        if run.returncode != 2:
            check_honest(self.folder / "run", run.returncode)


class Geometry(Attack):
    """Damaged meshes and octrees, as other programs write them too."""

    def prepare(self):
        shutil.copytree(self.problems / "robots", self.folder / "robots")
        self.files = {file.name: file.read_bytes() for kind in ("meshes", "maps") for file in (self.problems / kind).iterdir()}
        corners = [[-12, -4], [12, -4], [12, 4], [3, 4], [3, -2], [-3, -2], [-3, 4], [-12, 4]]
        self.files["doorway.obj"] = foreign.deck(corners, 10, 10.4).encode()
        self.files["map.obj"] = foreign.deck(corners, 523.1, 523.5, offset=(691234.5, 5334567.8)).encode()
        stl = self.files["girder.stl"]
        self.files["rounded.stl"] = foreign.noisy_stl(stl, random.Random(1), 1e-3)
        self.files["holed.stl"] = foreign.noisy_stl(stl, random.Random(2), 1e-3, missing=3, doubled=5, turned=5)
        self.files["color.ot"] = foreign.color_octree(random.Random(3))

    def attempt(self, draw):
        name = draw.choice(sorted(self.files))
        data = self.files[name]
        if draw.random() < 0.9:
            data = mutations.damaged(data, draw)
        (self.folder / name).write_bytes(data)
        keys = f"octomap: {{file: {name}" if name.endswith((".bt", ".ot")) else f"mesh: {{file: {name}, scale: {draw.choice([1, 0.001])}"
        (self.folder / "geometry.yaml").write_text(
            "schema: downwash/problem/v1\nname: geometry\nrobot: robots/ars_lrm.yaml\nenvironment:\n"
            "  bounds: {x_m: [-9, 6], z_m: [0.5, 10]}\n  obstacles:\n"
            "    - {name: ground, box: {size_m: [60, 60, 1], center_m: [0, 0, -0.5]}}\n"
            f"    - {{name: thing, {keys}, center_m: [0, {draw.choice([0, 30])}, 0]}}}}\n"
            "start: {x_m: -7, z_m: 8.5, arm_deg: 90}\ngoal: {configuration: {x_m: 2, z_m: 7.5, arm_deg: 90}}\n")
        self.program.run("check", "geometry.yaml", codes={0, 2}, limit_s=120)


class Tables(Attack):
    """Measurements, tables of K and grids in any dialect and encoding, whole or damaged, by every command that reads them."""

    def prepare(self):
        self.problem("bridge_inspection")
        self.program.run("aeromap", "build", "bridge_inspection.yaml", "--step", "1", "-o", "grid.csv", codes={0})
        self.grid = (self.folder / "grid.csv").read_text()
        self.table = "z_over_r,factor\n" + "".join(f"{z},{1 + 0.3 / (1 + z) ** 2}\n" for z in (0.3, 0.5, 1, 1.5, 2, 3, 5))
        self.data = self.table.replace("factor", "thrust_ratio")

    def attempt(self, draw):
        kind = draw.choice(["grid", "table", "data"])
        data = foreign.written(getattr(self, kind), draw)
        is_damaged = draw.random() < 0.7
        if is_damaged:
            data = mutations.damaged(data, draw)
        (self.folder / "file.csv").write_bytes(data)
        if kind == "grid":
            command = ["aeromap", "info", "file.csv"]
        elif kind == "data":
            command = draw.choice([["aeromap", "compare", "file.csv"], ["aeromap", "fit", "file.csv", "--model", "sanchez-cuevas"]])
        else:
            problem = self.problem("bridge_inspection")
            problem.write_text(problem.read_text() + "aero: {ground: {model: table, file: file.csv}}\n")
            command = ["check", problem]
        result = self.program.run(*command, codes={0, 2} if is_damaged else {0}, limit_s=120)
        said = result.stderr.decode(errors="replace")
        if result.returncode == 2 and not any(name in said for name in ("file.csv", "bridge_inspection.yaml")):
            raise Finding(f"an error does not name its file: {said[:500]}")


class Results(Attack):
    """Damaged files of a run, of a campaign and of measurements, by every command that reads them."""

    def prepare(self):
        self.run_folder = self.solved("good")
        (self.folder / "campaign.yaml").write_text(
            "schema: downwash/campaign/v1\nname: small\ndescription: small\nproblems: [bridge_inspection.yaml]\n"
            "variants: [mp-arm-ada, mp-arm]\nseeds: {first: 1, count: 2}\nmax_iterations: 10\n")
        self.program.run("bench", "run", "campaign.yaml", "--out", "campaign", "--quiet", codes={0, 3})
        self.program.run("aeromap", "build", "bridge_inspection.yaml", "--step", "0.5", "-o", "grid.csv")

    def attempt(self, draw):
        work = self.folder / "bad"
        shutil.rmtree(work, ignore_errors=True)
        kind = draw.choice(["run", "run", "campaign", "grid.csv", "grid.csv"])
        if kind == "run":
            shutil.copytree(self.run_folder, work)
            name = draw.choice(["solution.json", "trajectory.csv", "tree.csv", "effective.yaml"])
            commands = [["report", work], ["export", work, "--format", "csv", "-o", "out"],
                        ["execute", "bridge_inspection.yaml", "--plan", work / "solution.json", "--out", "flown", "--quiet"],
                        ["validate", "bridge_inspection.yaml", "--plan", work / "solution.json"]]
        elif kind == "campaign":
            shutil.copytree(self.folder / "campaign", work)
            name = draw.choice(sorted(file.name for file in work.glob("*.db")))
            commands = [["bench", "report", work], ["bench", "report", work, "--json"]]
        else:
            work.mkdir()
            shutil.copy(self.folder / kind, work)
            name = kind
            commands = [["aeromap", "info", work / name]]
        victim = work / name
        victim.write_bytes(mutations.damaged(victim.read_bytes(), draw))
        for command in commands:
            self.program.run(*command, limit_s=120)


class Robots(Attack):
    """Robots with a few valid numbers at the ends of their ranges."""

    def prepare(self):
        schema = finite(self.program.run("check", "--schema", "robot").stdout.decode(), "the schema")
        self.ranges = {}

        def visit(node, key):
            if node.get("type") == "number":
                low = node.get("minimum", node.get("exclusiveMinimum", -1e6))
                self.ranges[key] = (low, node.get("maximum", node.get("exclusiveMaximum", 1e6)))
            for name, below in node.get("properties", {}).items():
                visit(below, name)

        visit(schema, "")

    def extreme(self, low: float, high: float, draw: random.Random) -> float:
        if draw.random() < 0.3:
            return draw.choice([low, high])
        size = max(abs(low), abs(high))
        drawn = size * 10 ** draw.uniform(-300 if draw.random() < 0.2 else -12, 0)
        return min(max(drawn if high > 0 else -drawn, low), high)

    def attempt(self, draw):
        text = (self.problems / "robots" / "ars_lrm.yaml").read_text()
        present = [key for key in self.ranges if re.search(rf"\b{key}: *-?[0-9.]+", text)]
        for key in draw.sample(present, draw.choice([1, 1, 2, 3])):
            value = self.extreme(*self.ranges[key], draw)
            text = re.sub(rf"\b{key}: *-?[0-9.]+", f"{key}: {value!r}", text, count=1)
        (self.folder / "robot.yaml").write_text(text)
        file = self.problem(draw.choice(["bridge_inspection", "open_air"]), robot="robot.yaml")
        shutil.rmtree(self.folder / "run", ignore_errors=True)
        run = self.program.run("solve", file, *QUICK, "--out", "run", limit_s=120)
        if run.returncode != 2:
            check_honest(self.folder / "run", run.returncode)
            self.program.run("report", "run", codes={0})


class Kills(Attack):
    """SIGKILL while a run replaces another: the folder holds one of them, whole."""

    def prepare(self):
        self.solved("run")
        self.other = self.problem("open_air")

    def attempt(self, draw):
        file = draw.choice([self.folder / "bridge_inspection.yaml", self.other])
        self.program.interrupted("solve", file, "--max-iterations", "5", "--force", "--out", "run",
                                 signal_number=signal.SIGKILL, after_s=draw.uniform(0, 0.6))
        self.program.run("report", "run", "-o", "page.html", codes={0})
        whole = json.loads((self.folder / "run" / "solution.json").read_text())
        effective = (self.folder / "run" / "effective.yaml").read_text()
        if f"name: {whole['problem']['name']}" not in effective.replace('"', ""):
            raise Finding("solution.json and effective.yaml are of different problems")


class Interrupts(Attack):
    """SIGINT and SIGTERM at any moment: ended soon, with readable files or none."""

    def prepare(self):
        for name in ("bridge_inspection", "pipe_rack", "girder_mesh"):
            self.problem(name)

    def attempt(self, draw):
        shutil.rmtree(self.folder / "run", ignore_errors=True)
        name = draw.choice(["bridge_inspection", "pipe_rack", "girder_mesh"])
        number = draw.choice([signal.SIGINT, signal.SIGTERM])
        result, took_s = self.program.interrupted(
            "solve", f"{name}.yaml", "--time-limit", "60", "--no-cache", "--out", "run", signal_number=number,
            after_s=draw.uniform(0, 2))
        if took_s > 2:  # a tenth of a second, the page, and a machine that does other things
            raise Finding(f"{name} ends {took_s:.1f} s after its signal")
        if result.returncode == 128 + number and (self.folder / "run" / "solution.json").exists():
            if finite((self.folder / "run" / "solution.json").read_text(), "solution.json")["interrupted"] is not True:
                raise Finding("an interrupted run does not say so")


class Tours(Attack):
    """A search for a way through three goals, interrupted after its first whole way: a whole, certified way."""

    GOALS = ["{end_effector: {x_m: -9, z_m: 9.3, tolerance_m: 0.15}, hold_s: 4}",
             "{end_effector: {x_m: 1.5, z_m: 6, tolerance_m: 0.15}, hold_s: 4}",
             "{end_effector: {x_m: 2, z_m: 8.5, tolerance_m: 0.15}, hold_s: 4}"]

    def prepare(self):
        text = self.problem("bridge_inspection").read_text().replace("uncertainty: none", "uncertainty: {}")
        goals = "goal:\n" + "".join(f"  - {goal}\n" for goal in self.GOALS)
        self.file = self.folder / "tour.yaml"
        self.file.write_text(re.sub(r"^goal:\n( .*\n)*", goals, text, flags=re.MULTILINE))
        self.program.run("check", self.file, codes={0})

    def attempt(self, draw):
        shutil.rmtree(self.folder / "run", ignore_errors=True)
        process = self.program.start("solve", self.file, "--time-limit", "120", "--seed", str(draw.randrange(10**6)), "--out", "run")
        for line in process.stderr:
            if b"best planned cost" in line:
                break
        time.sleep(draw.uniform(0, 5))
        process.send_signal(signal.SIGINT)
        out, err = self.program.end_of(process, ["solve", "tour.yaml"], 30)
        self.program.judged(["solve", "tour.yaml"], process.returncode, out, err, {130})
        solution = finite((self.folder / "run" / "solution.json").read_text(), "solution.json")
        goals = solution["execution"]["goals"]
        if solution["status"] != "solved" or len(goals) != len(self.GOALS) or not all(goal["met"] for goal in goals):
            raise Finding(f"interrupted after a whole way: {solution['status']}, goals {goals}")
        if not solution["certificate"]["given"]:
            raise Finding("interrupted after a whole way: no certificate")


class Cache(Attack):
    """Runs that share a cache, some of whose files are damaged, come to the bytes of a run without one."""

    def prepare(self):
        self.file = self.problem("bridge_inspection")
        self.expected = self.trajectory("plain", "--no-cache")

    def trajectory(self, out, *options) -> bytes:
        shutil.rmtree(self.folder / out, ignore_errors=True)
        self.program.run("solve", self.file, *QUICK, "--out", out, *options)
        return (self.folder / out / "trajectory.csv").read_bytes()

    def attempt(self, draw):
        for map_file in (self.folder / "cache").rglob("*"):
            if map_file.is_file() and draw.random() < 0.5:
                map_file.write_bytes(mutations.damaged(map_file.read_bytes(), draw))
        runs = [self.program.start("solve", self.file, *QUICK, "--out", f"run{i}") for i in range(3)]
        for i, run in enumerate(runs):
            out, err = self.program.end_of(run, ["solve", i], 60)
            self.program.judged(["solve", i], run.returncode, out, err, GOOD_CODES)
            if (self.folder / f"run{i}" / "trajectory.csv").read_bytes() != self.expected:
                raise Finding(f"run {i} flies otherwise with a cache")


class Injection(Attack):
    """Names and descriptions that mean something to a format that they are written in."""

    PAYLOADS = ["]]>", "</script><script>alert(1)</script>", "<!-- -->", "&amp;<b>", "'\"`$(id)`", "{{7*7}}", "%s%n%x", "\\\"}],",
                "\u202e\u2028\u0000"[:2], "=cmd|' /C calc'!A0", "a,b;c\td", "../../x", "</svg>", "é\U0001f681"]

    def attempt(self, draw):
        payload = draw.choice(self.PAYLOADS) + draw.choice(["", "".join(draw.choices(self.PAYLOADS, k=2))])
        quoted = json.dumps(payload, ensure_ascii=False)
        file = self.problem("bridge_inspection", description=quoted)
        file.write_text(file.read_text().replace("{name: deck,", f"{{name: {quoted},"))
        shutil.rmtree(self.folder / "run", ignore_errors=True)
        self.program.run("solve", file, *QUICK, "--out", "run", codes={0, 1, 3})
        page = (self.folder / "run" / "report.html").read_text() if (self.folder / "run" / "report.html").exists() else ""
        if "<script>alert" in page or page.count("</html>") > 1:
            raise Finding(f"{payload!r} is part of the page's code")
        self.program.run("report", "run", "--svg", codes={0})
        for picture in (self.folder / "run").glob("*.svg"):
            self.well_formed(picture)
        for form in ("csv", "ros", "px4", "px4-csv", "mavlink", "qgc", "vtp", "vtp-scene", "glb"):
            out = self.folder / f"out.{form}"
            origin = ["--origin", "47", "8", "400"] if form == "qgc" else []
            self.program.run("export", "run", "--anyway", "--format", form, *origin, "-o", out, codes={0})
            if form in ("ros", "px4", "qgc"):
                finite(out.read_text(), form)
            elif form.startswith("vtp"):
                self.well_formed(out)

    @staticmethod
    def well_formed(file: pathlib.Path):
        try:
            xml.dom.minidom.parse(str(file))
        except xml.parsers.expat.ExpatError as error:
            raise Finding(f"{file.name} is not XML: {error}") from None


class Repeats(Attack):
    """The same seed and iterations give the same bytes on any number of threads."""

    def attempt(self, draw):
        name = draw.choice(["bridge_inspection", "box_girder_bay", "pipe_rack", "window", "culvert"])
        options = ["--variant", draw.choice(["mp-arm-ada", "mp-arm-da", "mp-arm"]), "--seed", str(draw.randrange(1000)),
                   "--max-iterations", str(draw.randrange(1, 120))]
        bytes_of = set()
        for threads in draw.sample(["1", "2", "3", "5"], 2):
            shutil.rmtree(self.folder / "run", ignore_errors=True)
            self.program.run("solve", self.problem(name), *options, "--time-limit", "600", "--quiet", "--out", "run", "--threads",
                             threads)
            solution = re.sub(r'"(\w*wall_s|threads)": [^,\n]*', "", (self.folder / "run" / "solution.json").read_text())
            bytes_of.add((solution, (self.folder / "run" / "trajectory.csv").read_bytes()))
        if len(bytes_of) != 1:
            raise Finding(f"{name} {options} differs between numbers of threads")


@dataclasses.dataclass
class Kind:
    name: str
    tries: int
    attack: type

    @property
    def what(self) -> str:
        return self.attack.__doc__


KINDS = [
    Kind("problems", 3500, Problems),
    Kind("geometry", 700, Geometry),
    Kind("tables", 700, Tables),
    Kind("results", 1600, Results),
    Kind("robots", 360, Robots),
    Kind("kills", 400, Kills),
    Kind("interrupts", 80, Interrupts),
    Kind("tours", 100, Tours),
    Kind("cache", 120, Cache),
    Kind("injection", 360, Injection),
    Kind("repeats", 150, Repeats),
]
