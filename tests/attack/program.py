"""Runs of the program under limits, and what must hold of each of them."""

import os
import pathlib
import resource
import signal
import subprocess
import time

MEMORY_BYTES = 2 << 30
# 0 done, 1 no solution, 2 bad input, 3 a plan whose flight failed
GOOD_CODES = {0, 1, 2, 3}


class Finding(Exception):
    """Something that must not happen."""


class Program:
    """The program in a scratch folder with a cache of its own."""

    def __init__(self, executable: pathlib.Path, folder: pathlib.Path):
        self.executable = executable
        self.folder = folder
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(folder / "cache"), LC_ALL="C.UTF-8")

    def start(self, *arguments) -> subprocess.Popen:
        return subprocess.Popen(
            [str(self.executable), *map(str, arguments)], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES)))

    def run(self, *arguments, limit_s: float = 60, codes=GOOD_CODES) -> subprocess.CompletedProcess:
        """Runs to the end. A crash, a hang, another exit code, or an error without a word is a finding."""
        process = self.start(*arguments)
        out, err = self.end_of(process, arguments, limit_s)
        return self.judged(arguments, process.returncode, out, err, codes)

    def interrupted(self, *arguments, signal_number: int, after_s: float, limit_s: float = 5):
        """Sends a signal some time after the start. Gives the result and how long the end took [s]."""
        process = self.start(*arguments)
        time.sleep(after_s)
        process.send_signal(signal_number)
        begin = time.monotonic()
        out, err = self.end_of(process, arguments, limit_s)
        took_s = time.monotonic() - begin
        if signal_number == signal.SIGKILL:
            return subprocess.CompletedProcess(arguments, process.returncode, out, err), took_s
        codes = GOOD_CODES | {128 + signal_number, -signal_number}  # before its handler is there the signal's default acts
        return self.judged(arguments, process.returncode, out, err, codes), took_s

    @staticmethod
    def end_of(process: subprocess.Popen, arguments, limit_s: float) -> tuple[bytes, bytes]:
        """What a program says until it ends. One that goes on for longer than a limit is a finding."""
        try:
            return process.communicate(timeout=limit_s)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            raise Finding(f"{shown(arguments)}: does not end within {limit_s} s") from None

    @staticmethod
    def judged(arguments, code: int, out: bytes, err: bytes, codes) -> subprocess.CompletedProcess:
        said = err.decode(errors="replace")
        if code not in codes:
            raise Finding(f"{shown(arguments)}: ends with {code}\n{said[-2000:]}")
        if code == 2 and not said.strip():
            raise Finding(f"{shown(arguments)}: ends with 2 and does not say why")
        if "bug in downwash" in said:
            raise Finding(f"{shown(arguments)}: {said[-2000:]}")
        return subprocess.CompletedProcess(arguments, code, out, err)


def shown(arguments) -> str:
    return "downwash " + " ".join(map(str, arguments))
