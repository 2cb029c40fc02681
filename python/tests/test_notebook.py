"""Every cell of the notebook among the examples."""

from __future__ import annotations

import json
import pathlib
from typing import Any

import pytest

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "notebook"


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("*.ipynb")), ids=lambda file: file.name)
def test_every_cell_runs(file: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
    names: dict[str, Any] = {"__name__": "notebook"}
    sources = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    assert sources
    for number, source in enumerate(sources):
        exec(compile(source, f"{file.name}, cell {number}", "exec"), names)
    assert "data:image/svg+xml" in names["roadmap"]._repr_html_()


def test_there_is_a_notebook() -> None:
    assert list(EXAMPLES.glob("*.ipynb"))
