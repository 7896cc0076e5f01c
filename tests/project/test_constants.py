"""Numbers at the heads of files say what they are: their unit, and what chose them."""

from __future__ import annotations

import ast
import re

import pytest
from places import ROOT

FILES = [path for package in ("geodesics", "gmds") for path in sorted((ROOT / package).rglob("*.py"))]


def is_number(node: ast.expr) -> bool:
    """Whether an expression is made of numbers alone."""
    return all(
        isinstance(part, ast.Constant | ast.Tuple | ast.BinOp | ast.UnaryOp | ast.operator | ast.unaryop | ast.Load)
        and not (isinstance(part, ast.Constant) and not isinstance(part.value, int | float))
        for part in ast.walk(node)
    ) and any(isinstance(part, ast.Constant) for part in ast.walk(node))


def bare_constants(text: str) -> list[str]:
    """The numeric constants of a file with no word beside, above or (as a docstring) below them.

    A comment above a group of constants holds for all lines up to the next blank one.
    """
    lines, tree, bare = text.splitlines(), ast.parse(text), []
    for number, node in enumerate(tree.body):
        if not (isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and is_number(node.value)):
            continue
        own = any("#" in line for line in lines[node.lineno - 1 : node.end_lineno])
        above = node.lineno - 2
        while above >= 0 and re.match(r"_?[A-Z]", lines[above]):
            above -= 1
        below = tree.body[number + 1] if number + 1 < len(tree.body) else None
        said = isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant)
        if node.targets[0].id.isupper() and not (own or said or (above >= 0 and lines[above].startswith("#"))):
            bare.append(node.targets[0].id)
    return bare


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_number_has_a_word(path: object) -> None:
    assert bare_constants(path.read_text(encoding="utf-8")) == []  # type: ignore[attr-defined]


def test_what_counts_as_bare() -> None:
    text = '"""A file."""\n\nA = 3\nB = 4  # metres\n\n# seconds\nC = 1.5\nD = (1, -2.0)\n\n'
    text += 'E = "x"\nF = 2\n"""A page."""\n_state = 0\n'
    assert bare_constants(text) == ["A"]
