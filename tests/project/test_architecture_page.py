"""docs/architecture.md: the picture and the table are those of the code, and every name is where the page says."""

from __future__ import annotations

import ast
import re
import runpy
from typing import Any

import pytest
from places import ROOT

pytestmark = pytest.mark.skipif(not (ROOT / "gmds").is_dir(), reason="the packages do not lie beside the tests")
PAGE = ROOT / "docs" / "architecture.md"
LINKS = re.findall(r"\[`(\w+(?:\.\w+)*)`\]\(\.\./([\w/]+\.py)\)", PAGE.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def drawn() -> dict[str, Any]:
    return runpy.run_path(str(ROOT / "docs" / "floors.py"))


def test_the_picture_is_that_of_the_code(drawn: dict[str, Any]) -> None:
    assert drawn["PICTURE"].read_text(encoding="utf-8") == drawn["picture"](), "python docs/floors.py draws it anew"


def test_the_table_is_that_of_the_docstrings(drawn: dict[str, Any]) -> None:
    assert PAGE.read_text(encoding="utf-8") == drawn["page"](), "python docs/floors.py writes it anew"


def test_every_room_stands_on_a_floor_and_uses_what_is_below(drawn: dict[str, Any]) -> None:
    uses = drawn["rests_on"](drawn["modules"]())
    floors = drawn["floors"](set(uses))
    assert sorted(name for floor in floors for name in floor) == sorted(uses)
    level = {name: number for number, floor in enumerate(floors) for name in floor}
    upward = [(one, other) for one, others in uses.items() for other in others if level[other] < level[one]]
    assert not upward and max(level.values()) > 8


@pytest.mark.parametrize(("name", "path"), sorted(set(LINKS)))
def test_a_name_is_in_the_file_that_it_links_to(name: str, path: str) -> None:
    body: list[ast.stmt] = ast.parse((ROOT / path).read_text(encoding="utf-8")).body
    for part in name.split("."):
        assert part in defined(body), f"{path} has no {name}"
        body = getattr(defined(body)[part], "body", [])


def defined(body: list[ast.stmt]) -> dict[str, ast.stmt]:
    """What a module or a class defines, by name."""
    found: dict[str, ast.stmt] = {}
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found[node.name] = node
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            found |= {target.id: node for target in targets if isinstance(target, ast.Name)}
    return found


@pytest.mark.parametrize(
    ("wanted", "name"),
    [
        ("eq. (2.1)", "scale_invariant"),
        ("the negative log-likelihood of a proposal", "Proposal.neg_log_likelihood"),
        ("the energy of a registration", "AsSimilarAsPossible"),
        (".fcsv", "parse_fcsv"),
        ("what decides `status`", "status_of"),
        ("how a part is looked for", "part_maps"),
    ],
)
def test_what_is_often_looked_for_has_a_row(wanted: str, name: str) -> None:
    table = PAGE.read_text(encoding="utf-8").split("## Where to change what")[1].split("\n## ")[0]
    assert any(wanted in row and f"[`{name}`]" in row for row in table.splitlines())
