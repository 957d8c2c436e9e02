"""Builds the Python package: CMake makes the extension module.

By itself, it builds all of the library into the module. With the variable of the environment DOWNWASH_BUILD, it takes
module and libraries from that build folder of CMake, where most is compiled already.
"""

from __future__ import annotations

import importlib.util
import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent
# What the package does not use.
LEFT_OUT = ("CLI", "CAMPAIGNS", "EXPORTS", "FITTING", "IDENTIFICATION", "ROBOT_IMPORT", "TESTS", "BENCH")


def cache_of(build: pathlib.Path) -> dict[str, str]:
    """The variables of a build folder that has been configured."""
    lines = (build / "CMakeCache.txt").read_text(encoding="utf-8").splitlines()
    return {found[1]: found[2] for line in lines if (found := re.match(r"([\w-]+):\w+=(.*)", line))}


def given_build() -> pathlib.Path | None:
    """The build folder that the user names; None without one."""
    named = os.environ.get("DOWNWASH_BUILD")
    if not named:
        return None
    build = (ROOT / named).resolve()
    if not (build / "CMakeCache.txt").is_file():
        raise SystemExit(f"DOWNWASH_BUILD: {build} is no build folder of CMake. Build it first: `./dev build`.")
    home = cache_of(build).get("CMAKE_HOME_DIRECTORY", "")
    if pathlib.Path(home).resolve() != ROOT:
        raise SystemExit(f"DOWNWASH_BUILD: {build} is a build of {home}, not of {ROOT}.")
    return build


def options_of(build: pathlib.Path, is_given: bool) -> dict[str, str] | None:
    """What CMake has to be told; None where it has been told all."""
    if not is_given:
        return {
            "CMAKE_BUILD_TYPE": "Release",
            "BUILD_SHARED_LIBS": "OFF",
            "DOWNWASH_PYTHON": "ON",
            "Python_EXECUTABLE": sys.executable,
            **{f"DOWNWASH_BUILD_{name}": "OFF" for name in LEFT_OUT},
        }
    if cache_of(build).get("DOWNWASH_PYTHON") == "ON":
        return None
    # Not the Python of a virtual environment, which may go sooner than the build.
    return {"DOWNWASH_PYTHON": "ON", "Python_EXECUTABLE": getattr(sys, "_base_executable", sys.executable)}


class BuildWithCMake(build_ext):
    """Builds and installs the component `wheel` of CMakeLists.txt."""

    def build_extension(self, extension: Extension) -> None:
        """Puts the extension module where setuptools expects it, and the libraries that it needs beside it."""
        module = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        build = GIVEN or WORK / "cmake"
        options = options_of(build, GIVEN is not None)
        if options is not None:
            run("cmake", "-S", ROOT, "-B", build, *(f"-D{name}={value}" for name, value in options.items()))
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        run("cmake", "--build", build, "--target", "downwash_python", "--parallel", jobs)
        run("cmake", "--install", build, "--component", "wheel", "--prefix", module.parent.parent)
        if not module.is_file():
            made = ", ".join(path.name for path in module.parent.glob("_core*.so"))
            raise SystemExit(
                f"DOWNWASH_BUILD: {build} makes the module of another Python: {made}, not {module.name}.\n"
                f"Use that Python, or give it this one (cmake -B {build} -DPython_EXECUTABLE={sys.executable}), or unset "
                "DOWNWASH_BUILD, which builds everything for this one."
            )
        # Wheels know no links: a library gets the name by which it is looked for.
        for link in list(module.parent.glob("libdownwash_*.so.*")):
            if link.is_symlink():
                link.resolve().replace(link)


def run(*command: str | os.PathLike[str]) -> None:
    """Runs a command that has to succeed."""
    subprocess.run(command, check=True)


def version() -> str:
    """The version of the whole project."""
    found = re.search(r"project\(downwash VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
    assert found is not None
    return found[1]


def require_wheels() -> None:
    """Stops where setuptools cannot make wheels: it did not before version 70.1 without the package `wheel`."""
    if importlib.util.find_spec("setuptools.command.bdist_wheel") or importlib.util.find_spec("wheel"):
        return
    raise SystemExit(
        f"{sys.executable} has no package `wheel`, which setuptools before version 70.1 needs to build this package.\n"
        "Either let pip fetch what it needs: `pip install .`, without --no-build-isolation and --no-index;\n"
        "or, without network, use Debian's Python, for which `./dev setup` installs all: `/usr/bin/python3 -m venv "
        "--system-site-packages my-environment`."
    )


require_wheels()
GIVEN = given_build()
# Not in build/, where CMake's own build is.
WORK = GIVEN / "wheel-parts" if GIVEN else ROOT / "build-python"
WORK.mkdir(exist_ok=True)
setup(
    version=version(),
    packages=["downwash"],
    package_dir={"downwash": "apps/python/downwash"},
    package_data={"downwash": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("downwash._core", [])],
    cmdclass={"build_ext": BuildWithCMake},
    options={"build": {"build_base": str(WORK / "setuptools")}, "egg_info": {"egg_base": str(WORK)}},
    zip_safe=False,
)
