"""Files of problems/ that are generated and checked in."""

import pathlib
import sys

PROBLEMS = pathlib.Path(__file__).resolve().parent.parent


def write_files(files, folder):
    """@param files what stands below the folder, by path: bytes"""
    for name, content in files.items():
        file = pathlib.Path(folder) / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)


def read(file):
    return file.read_bytes() if file.is_file() else None


def check_or_write(files, arguments=None):
    """Writes files below problems/ or, with the argument --check, ends with 1 where one of them has other bytes."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments not in ([], ["--check"]):
        sys.exit(f"{sys.argv[0]}: expected no argument or --check, not {' '.join(arguments)}")
    if not arguments:
        write_files(files, PROBLEMS)
        return
    wrong = [name for name, content in files.items() if read(PROBLEMS / name) != content]
    for name in wrong:
        print(f"problems/{name} is not what {pathlib.Path(sys.argv[0]).name} makes: run it", file=sys.stderr)
    sys.exit(1 if wrong else 0)
