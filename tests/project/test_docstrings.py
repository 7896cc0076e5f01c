"""The site shows docstrings as they were meant: plain text, sections and formulas."""

from __future__ import annotations

import runpy

import pytest
from places import ROOT

DOCS = ROOT / "docs"


def shown(text: str) -> list[str]:
    lines = text.splitlines()
    runpy.run_path(str(DOCS / "docstrings.py"))["plain"](None, "function", "f", None, None, lines)
    return lines


def test_plain_text_keeps_its_bars_and_stars() -> None:
    assert shown("|K|^a * g of `a * b`, x_ and x_i.") == [r"\|K\|^a \* g of `a * b`, x\_ and x_i."]


def test_what_is_written_for_sphinx_stays() -> None:
    text = r"""Some |K|.

.. math::
    a_ &= |b| * c \\

    d &= e

With :math:`|K|^a` again |K|.

>>> print(2 * 3)  # |
6
"""
    lines = shown(text)
    assert lines[2:7] == text.splitlines()[2:7]
    assert lines[7] == r"With :math:`|K|^a` again \|K\|." and lines[0] == r"Some \|K\|."
    assert lines[9:11] == text.splitlines()[9:11]


def test_a_directive_within_a_section_ends_where_its_indentation_ends() -> None:
    lines = shown("Returns\n-------\nFloats\n    The |K|,\n\n    .. math:: |K|\n       + |H|\n\n    with |H|.\n")
    assert lines[3:] == [r"    The \|K\|,", "", "    .. math:: |K|", "       + |H|", "", r"    with \|H\|."]


def test_tables_are_tables() -> None:
    lines = shown("Codes:\n\n| code | says |\n|---|---|\n| W210 | a*b |\n")
    assert lines[2:4] == [".. list-table::", "   :header-rows: 1"] and r"     - a\*b" in lines


@pytest.fixture
def mathml():
    pytest.importorskip("math_core")
    nodes = pytest.importorskip("docutils.nodes")
    module = runpy.run_path(str(DOCS / "mathml.py"))
    return lambda tex, block: module["mathml"]((nodes.math_block if block else nodes.math)(tex, tex), block=block)


def test_formulas_are_typeset_without_a_script(mathml) -> None:
    assert mathml(r"|K|^a", False).startswith("<math><mo") and "<msup>" in mathml(r"|K|^a", False)
    lines = mathml(r"a &= b \\ c &= d", True)
    assert lines.startswith('<math display="block">') and lines.count("<mtr>") == 2


def test_a_command_that_does_not_exist_is_reported(mathml, caplog: pytest.LogCaptureFixture) -> None:
    assert mathml(r"a < \fractal{1}", False) == r"<code>a &lt; \fractal{1}</code>"
    assert "fractal" in caplog.text
