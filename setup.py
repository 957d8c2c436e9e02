"""Builds the Python package: CMake makes the extension module, with the library inside."""

import importlib.util
import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent
BUILD = ROOT / "build-python"
# What the package does not use.
LEFT_OUT = ("CLI", "CAMPAIGNS", "EXPORTS", "FITTING", "TESTS", "BENCH")


class BuildWithCMake(build_ext):
    """Builds and installs the component `python` of CMakeLists.txt."""

    def build_extension(self, extension: Extension) -> None:
        """Puts the extension module where setuptools expects it."""
        place = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve().parent.parent
        build = BUILD / "cmake"
        options = {
            "CMAKE_BUILD_TYPE": "Release",
            "BUILD_SHARED_LIBS": "OFF",
            "DOWNWASH_PYTHON": "ON",
            "DOWNWASH_PYTHON_DIR": ".",
            "Python_EXECUTABLE": sys.executable,
            **{f"DOWNWASH_BUILD_{name}": "OFF" for name in LEFT_OUT},
        }
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        for command in (
            ["cmake", "-S", ROOT, "-B", build, *(f"-D{name}={value}" for name, value in options.items())],
            ["cmake", "--build", build, "--target", "downwash_python", "--parallel", jobs],
            ["cmake", "--install", build, "--component", "python", "--prefix", place],
        ):
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
BUILD.mkdir(exist_ok=True)
setup(
    version=version(),
    packages=["downwash"],
    package_dir={"downwash": "apps/python/downwash"},
    package_data={"downwash": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("downwash._core", [])],
    cmdclass={"build_ext": BuildWithCMake},
    # Not in build/, where CMake's own build is.
    options={"build": {"build_base": str(BUILD / "setuptools")}, "egg_info": {"egg_base": str(BUILD)}},
    zip_safe=False,
)
