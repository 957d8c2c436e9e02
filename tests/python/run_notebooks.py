#!/usr/bin/python3
"""Runs every notebook of apps/python/notebooks in its folder, and checks that the files hold no outputs."""

import os
import pathlib
import sys

import nbformat
from nbclient import NotebookClient

FOLDER = pathlib.Path(__file__).resolve().parent.parent.parent / "apps" / "python" / "notebooks"


def main() -> int:
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # the debugger need not warn that it cannot debug Python itself
    files = sorted(FOLDER.glob("*.ipynb"))
    assert files, f"no notebooks in {FOLDER}"
    for file in files:
        notebook = nbformat.read(file, as_version=4)
        nbformat.validate(notebook)
        for cell in notebook.cells:
            if cell.cell_type == "code" and (cell.outputs or cell.execution_count is not None):
                print(f"{file}: clear the outputs before you commit")
                return 1
        NotebookClient(notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": FOLDER}}).execute()
        print(f"{file.name}: ran {sum(cell.cell_type == 'code' for cell in notebook.cells)} cells")
    return 0


if __name__ == "__main__":
    sys.exit(main())
