"""The examples in the documentation run."""

import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SHORTER = {"runs=1000": "runs=5", "max_iterations=300": "max_iterations=40"}


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_the_examples_of_a_page_run_one_after_the_other(page, tmp_path, monkeypatch, folder, bridge, results):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "problems").symlink_to(folder)
    (tmp_path / "downwash-out").mkdir()
    (tmp_path / "downwash-out" / "campaign").symlink_to(results)
    text = (folder / "open_air.yaml").read_text(encoding="utf-8")
    names = {"text": text, "document": bridge.to_dict("problems"), "points": [[0.0, 5.0], [2.0, 9.2]]}
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL)
    assert blocks
    for block in blocks:
        for long, short in SHORTER.items():
            block = block.replace(long, short)
        exec(compile(block, page, "exec"), names)  # noqa: S102
