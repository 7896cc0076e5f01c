"""README's paper map: every name in it exists, and says which equation or figure it stands for."""

from __future__ import annotations

import importlib
import inspect
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
CITATION = re.compile(r"\(\d\.\d\)|sec\. \d|Theorem \d\.\d|Fig\. \d|footnote \d|abstract")


def rows() -> list[tuple[str, str, list[str]]]:
    """(what is cited, what it is, dotted names or script paths) of every row of the table."""
    table = README.split("## The paper, line by line", 1)[1].split("\n## ", 1)[0]
    cells = [
        [cell.strip() for cell in line.strip("| ").split("|")] for line in table.splitlines() if line.startswith("|")
    ]
    return [(paper, what, re.findall(r"`([^`]+)`", names)) for paper, what, names in cells[2:]]


ENTRIES = [(paper, name) for paper, _, names in rows() for name in names]


def described(name: str) -> str:
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
    text = " ".join(described(name).split())
    missing = [citation for citation in CITATION.findall(paper) if citation not in text]
    assert not missing, f"{name} does not mention {missing}"


@pytest.mark.parametrize(
    "citation", ["(2.1)", "(3.1)", "(3.2)", "(4.4)", "(4.5)", "(5.1)", "(7.1)", "footnote 1", "sec. 5"]
)
def test_no_equation_is_forgotten(citation: str) -> None:
    assert any(citation in paper for paper, _ in ENTRIES)
