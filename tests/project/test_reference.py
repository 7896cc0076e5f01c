"""The pages of the reference: every public name, every command, and where links to them lead."""

from __future__ import annotations

import importlib
import re
import runpy

import pytest
from places import ROOT

from gmds.cli import main

GENERATED = runpy.run_path(str(ROOT / "docs" / "generated.py"))


@pytest.mark.parametrize("package", ["geodesics", "gmds"])
def test_every_public_name_is_in_the_reference(package: str) -> None:
    pages = (ROOT / "docs" / "reference" / package).rglob("*.md")
    text = "\n".join(page.read_text(encoding="utf-8") for page in pages)
    listed = re.findall(rf"^\.\. auto(?:function|class):: {package}\.(\w+)$", text, re.MULTILINE)
    assert sorted(listed) == importlib.import_module(package).__all__


@pytest.mark.parametrize("package", ["gmds", "geodesics"])
def test_formulas_in_summary_tables_are_formulas(package: str) -> None:
    """What is TeX is said to be mathematics, and bars of a formula do not end a cell."""
    summary = GENERATED["summary_of"](package)
    assert "{math}`" in summary
    rows = [line for line in summary.splitlines() if line.startswith("| {py:")]
    for row in rows:
        assert len(re.findall(r"(?<!\\)\|", row)) == 3, row
        assert not re.search(r"\\[a-z]{2,}", re.sub(r"\{math\}`[^`]*`", "", row)), row


def test_every_command_has_its_row_and_its_page() -> None:
    """Links from when all help stood on one page still lead to a row of that name."""
    pages = sorted((ROOT / "docs" / "reference" / "command-line").glob("*.md"))
    assert sorted(map(GENERATED["slug"], main.sections)) == [page.stem for page in pages]
    index, help_texts = GENERATED["every_section"](), [GENERATED["help_of"](page.stem) for page in pages]
    for name in main.command_names:
        assert index.count(f'id="gmds-{name}"') == 1
        assert sum(text.count(f"\n## gmds {name}\n") for text in help_texts) == 1


def test_names_on_a_page_that_was_divided_keep_their_place_there() -> None:
    summary = GENERATED["summary_of"]("gmds/shapes", places=True)
    for name in (
        "module-gmds.shapes",
        "gmds.shapes.quadruped",
        "gmds.deformations.cut",
        "gmds.deformations.Part.truth",
    ):
        assert summary.count(f'<span id="{name}"></span>') == 1
    assert "<span" not in GENERATED["summary_of"]("gmds")
