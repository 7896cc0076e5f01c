"""README: every name in its paper map exists and says what it stands for; its twelve lines run."""

from __future__ import annotations

import importlib
import inspect
import re
from pathlib import Path
from typing import Any

import pytest
from generated_shapes import bumpy_sphere, moved
from places import ROOT

from geodesics import write_mesh

README = (ROOT / "README.md").read_text(encoding="utf-8")
CITATION = re.compile(r"\(\d\.\d\)|sec\. \d|Theorem \d\.\d|Fig\. \d|Table \d|footnote \d|abstract")


def rows() -> list[tuple[str, str, list[str]]]:
    """(what is cited, what it is, dotted names or script paths) of every row of the table."""
    table = README.split("## The paper, line by line", 1)[1].split("\n## ", 1)[0]
    cells = [
        [cell.strip() for cell in line.strip("| ").split("|")] for line in table.splitlines() if line.startswith("|")
    ]
    return [(paper, what, re.findall(r"`([^`]+)`", names)) for paper, what, names in cells[2:]]


ENTRIES = [(paper, name) for paper, _, names in rows() for name in names]


def docstring_of(name: str) -> str:
    """The docstring of a dotted name, or the text of a script."""
    if name.endswith(".py"):
        return (ROOT / name).read_text(encoding="utf-8")
    module, attribute = name.rsplit(".", 1)
    return inspect.getdoc(getattr(importlib.import_module(module), attribute)) or ""


def test_the_map_is_a_table_of_names() -> None:
    assert len(ENTRIES) > 25
    assert all(CITATION.search(paper) and what and names for paper, what, names in rows())


@pytest.mark.parametrize(("paper", "name"), ENTRIES)
def test_every_name_cites_what_it_stands_for(paper: str, name: str) -> None:
    text = " ".join(docstring_of(name).split())
    missing = [citation for citation in CITATION.findall(paper) if citation.lower() not in text.lower()]
    assert not missing, f"{name} does not mention {missing}"


@pytest.mark.parametrize(
    "citation", ["(2.1)", "(3.1)", "(3.2)", "(4.4)", "(4.5)", "(5.1)", "(7.1)", "footnote 1", "sec. 5"]
)
def test_no_equation_is_forgotten(citation: str) -> None:
    assert any(citation in paper for paper, _ in ENTRIES)


def test_the_twelve_lines_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    monkeypatch.chdir(tmp_path)
    shape = bumpy_sphere(2)
    write_mesh(shape, tmp_path / "dog.ply")
    write_mesh(moved(shape), tmp_path / "wolf.off")
    code = README.split("```python\n", 1)[1].split("```", 1)[0]
    code = code.replace("[[0, 3], [7, 9]]", "[[0, 0], [7, 7]]")  # these two shapes are the same
    names: dict[str, Any] = {}
    exec(code, names)
    assert len(names["answer"].points) == len(names["labels"]) == shape.n_vertices
    assert "map" in capsys.readouterr().out
    assert (tmp_path / "map.npz").exists()
    assert len([line for line in code.splitlines() if line]) <= 12
