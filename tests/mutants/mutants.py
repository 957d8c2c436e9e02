#!/usr/bin/env python3
"""Plants faults in a copy of the source tree, one at a time, and checks that the tests notice them.

mutants.py [NAME...]                 the patches of this folder, or those named (MODULE or MODULE/NAME)
mutants.py --random N [--seed S]     N faults drawn at random over all modules
"""

import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCES = HERE.parent.parent
COPY = SOURCES / "build-mutants"
BUILD = COPY / "build"
JOBS = os.environ.get("JOBS", "2")
LONGEST_RUN_S = 600  # a mutant may never come to an end
# Folders with sources, from the lowest up; that of their tests has the last part of the name.
MODULES = ("base scene dynamics aeromap/effects aeromap/grids aeromap controllers simulation problems planner/search "
           "planner/ompl_planners planner results judge aeromap/fitting results/exports apps/report bench apps/cli").split()


class Error(Exception):
    """What keeps a mutant from being judged."""


def run(command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, errors="replace", check=False, **options)


# --- the copy -----------------------------------------------------------------------------------------------------


def refresh_copy():
    """Makes the copy equal to the source tree; untouched files keep their times, so that the build is incremental."""
    listed = run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=SOURCES)
    if listed.returncode != 0:
        raise Error(f"git cannot list the sources: {listed.stderr}")
    wanted = {name for name in listed.stdout.split("\0") if name and (SOURCES / name).is_file()}
    for path in COPY.rglob("*") if COPY.exists() else []:
        if path.is_file() and BUILD not in path.parents and str(path.relative_to(COPY)) not in wanted:
            path.unlink()
    for name in wanted:
        source, copy = SOURCES / name, COPY / name
        if not copy.exists() or copy.read_bytes() != source.read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(source.read_bytes())
            copy.chmod(source.stat().st_mode)


def configure():
    """With ccache, what a fault has changed is not compiled anew when it is taken back."""
    options = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    os.environ["CCACHE_BASEDIR"] = str(COPY)
    done = run(["cmake", "-G", "Ninja", "-S", COPY, "-B", BUILD, "-DCMAKE_BUILD_TYPE=Release",
                "-DDOWNWASH_BUILD_TESTS=ON", "-DDOWNWASH_BUILD_BENCH=OFF",
                "-DDOWNWASH_WERROR=OFF", *options])  # a fault may leave a variable unused
    if done.returncode != 0:
        raise Error(f"configuring failed:\n{done.stdout}{done.stderr}")


def build(targets):
    """The compiler's words if it fails, else nothing."""
    done = run(["cmake", "--build", BUILD, "--parallel", JOBS, "--target", *sorted(set(targets))])
    return done.stdout + done.stderr if done.returncode else ""


def regex_of(test):
    return "^" + re.sub(r"([][+.*()^$?|\\])", r"\\\1", test) + "$"


def failed_tests(regex):
    """The tests that fail, of those whose name matches."""
    try:
        done = run(["ctest", "--test-dir", BUILD, "-R", regex, "-j", JOBS, "--no-tests=error"], timeout=LONGEST_RUN_S)
    except subprocess.TimeoutExpired:
        return ["(no end)"]
    if "No tests were found" in done.stdout + done.stderr:
        raise Error(f"no test matches {regex}")
    return re.findall(r"^\s*\d+ - (.*) \([A-Za-z ]+\)$", done.stdout, re.MULTILINE)


# --- faults -------------------------------------------------------------------------------------------------------


class Patch:
    """A patch of this folder: its first line names the test that has to fail."""

    def __init__(self, path):
        self.name = str(path.relative_to(HERE).with_suffix(""))
        self.text = path.read_text()
        self.test = self.text.split("\n", 1)[0]
        self.target = "test_" + self.test.split("/", 1)[0]
        self.files = re.findall(r"^\+\+\+ b/(\S+)", self.text, re.MULTILINE)

    def plant(self):
        done = run(["patch", "-p1", "--fuzz=0", "--no-backup-if-mismatch", "-r", "-", "-d", COPY], input=self.text)
        if done.returncode != 0:
            raise Error("no longer applies: " + done.stdout.strip().replace("\n", "; "))


def plant_and_test(mutant, targets, tests):
    """Whether the tests notice the fault; the source is as before afterwards."""
    before = {name: (COPY / name).read_bytes() for name in mutant.files if (COPY / name).exists()}
    try:
        mutant.plant()
        if words := build(targets):
            raise Error("does not build:\n" + words[-2000:])
        return failed_tests(tests)
    finally:
        for name, content in before.items():
            (COPY / name).write_bytes(content)


def run_patches(names):
    patches = [Patch(path) for path in sorted(HERE.glob("*/*.patch"))]
    unknown = [name for name in names if not any(p.name == name or p.name.startswith(name + "/") for p in patches)]
    if unknown:
        raise Error(f"there is no mutant {', '.join(unknown)}")
    patches = [p for p in patches if not names or any(p.name == name or p.name.startswith(name + "/") for name in names)]
    if words := build(p.target for p in patches):
        raise Error("the tests do not build:\n" + words[-4000:])
    failing = failed_tests("|".join(sorted({regex_of(p.test) for p in patches})))
    unnoticed = broken = 0
    for patch in patches:
        begin = time.monotonic()
        try:
            if patch.test in failing:
                raise Error("the test fails without the fault, too")
            noticed = plant_and_test(patch, [patch.target], regex_of(patch.test))
            result = "caught" if noticed else "SURVIVED"
            unnoticed += not noticed
        except Error as error:
            result = f"ERROR {error}"
            broken += 1
        print(f"{time.monotonic() - begin:5.0f} s  {patch.name:55} {result:8}  {patch.test}", flush=True)
    print(f"{len(patches) - unnoticed - broken} of {len(patches)} faults were caught"
          + (f", {broken} could not be tried" if broken else ""))
    return unnoticed + broken == 0


# --- faults at random ---------------------------------------------------------------------------------------------

SWAPS = [(" < ", " <= "), (" > ", " >= "), (" <= ", " < "), (" >= ", " > "), (" == ", " != "), (" != ", " == "),
         (" + ", " - "), (" - ", " + "), (" * ", " / "), (" / ", " * "), (" += ", " -= "), (" -= ", " += "),
         (" && ", " || "), (" || ", " && "), ("std::min(", "std::max("), ("std::max(", "std::min("),
         ("lane::min(", "lane::max("), ("lane::max(", "lane::min("), ("true", "false"), ("false", "true"), ("(!", "("),
         ("++", "--"), ("std::sin(", "std::cos("), ("std::cos(", "std::sin("), ("continue;", "break;"),
         (".front()", ".back()"), (".back()", ".front()")]
STATEMENT = re.compile(r"^\s+(?!return|using|const|static|auto|throw|break|continue|case|for|if|else|while|[\w:<>]+ \w+[;({= ])"
                       r"[\w.*>\[\]()-]+( [-+*/]?= |\(|\+\+).*;$")
NUMBER = re.compile(r"(?<![\w.])(\d+\.\d*(?:e-?\d+)?|\d+)(?![\w.'])")


def changes_of(line):
    """What a line could become."""
    code = line.split("//", 1)[0]
    if '"' in code or code.lstrip().startswith(("#", "static_assert", "assert", "namespace", "template", "using", "*")):
        return []
    changes = [code[:m.start()] + new + code[m.end():] for old, new in SWAPS for m in re.finditer(re.escape(old), code)]
    for m in NUMBER.finditer(code):
        value = f"({m[1]} * 1.1)" if "." in m[1] and float(m[1]) else str(int(float(m[1])) + 1)
        changes.append(code[:m.start()] + value + code[m.end():])
    if STATEMENT.match(code.rstrip()):
        changes.append("")
    return changes


class Draw:
    """A change of one line, drawn at random."""

    def __init__(self, random_, module):
        path = random_.choice(sorted([*(COPY / module).glob("*.cpp"), *(COPY / module).glob("*.hpp")]))
        self.files = [str(path.relative_to(COPY))]
        self.lines = path.read_text().split("\n")
        number = random_.randrange(len(self.lines))
        self.changes = changes_of(self.lines[number])
        self.at, self.line = number, self.lines[number]
        self.new = random_.choice(self.changes) if self.changes else ""
        self.name = f"{self.files[0]}:{number + 1}"

    def plant(self):
        self.lines[self.at] = self.new
        (COPY / self.files[0]).write_text("\n".join(self.lines))


def test_programs(module):
    """The names under which the tests of a module add programs."""
    lists = SOURCES / "tests" / Path(module).name / "CMakeLists.txt"
    return re.findall(r"^\s*downwash_test\((\w+)", lists.read_text(), re.MULTILINE) if lists.exists() else []


def run_random(count, seed, names):
    """Tries the programs of the module's own folder first, then those of all folders above it."""
    modules = [module for module in MODULES if not names or Path(module).name in names]
    if unknown := set(names) - {Path(module).name for module in modules}:
        raise Error(f"there is no module {', '.join(sorted(unknown))}")
    random_ = random.Random(seed)
    caught = tried = 0
    while tried < count:
        module = random_.choice(modules)
        mutant = Draw(random_, module)
        if not mutant.changes:
            continue
        begin = time.monotonic()
        noticed = []
        try:
            for tried_now in [[module], MODULES[MODULES.index(module) + 1:]]:
                programs = [name for each in tried_now for name in test_programs(each)]
                if programs and not noticed:
                    tests = "^(" + "|".join(programs) + ")/"
                    noticed = plant_and_test(mutant, ["test_" + name for name in programs], tests)
        except Error:
            continue  # it does not compile
        tried += 1
        caught += bool(noticed)
        print(f"{time.monotonic() - begin:5.0f} s  {mutant.name:45} {'caught' if noticed else 'SURVIVED'}"
              f"\n        - {mutant.line.strip()}\n        + {mutant.new.strip()}\n        {'; '.join(noticed[:3])}", flush=True)
    print(f"{caught} of {tried} faults were caught (seed {seed})")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--random", type=int, metavar="N", help="draw N faults instead of planting patches")
    parser.add_argument("--seed", type=int, default=1, help="of the draw (default 1)")
    arguments = parser.parse_args()
    try:
        refresh_copy()
        configure()
        if arguments.random:
            return run_random(arguments.random, arguments.seed, arguments.names) or 0
        return 0 if run_patches(arguments.names) else 1
    except Error as error:
        print(f"mutants: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
