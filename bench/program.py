"""Runs the program for scripts that measure."""

import json
import pathlib
import subprocess
import sys


def run(program, *arguments):
    """What a command prints as JSON."""
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)
    try:
        return json.loads(done.stdout)
    except json.JSONDecodeError:
        script = pathlib.Path(sys.argv[0]).name
        raise SystemExit(f"bench/{script}: {' '.join(map(str, arguments))}: {done.stderr}") from None


def print_bound(bound, found, is_kept):
    """A row as bench/bars.sh reads it."""
    print(f"| {bound} | {found} | {'kept' if is_kept else '**not kept**'} |")
