"""The table of mesh formats in the reference says what reading and writing do."""

from __future__ import annotations

import runpy

import pytest
from places import ROOT

from geodesics.io.opening import SUPPORTED

PAGE = ROOT / "docs" / "reference" / "files.md"
pytest.importorskip("nibabel")


@pytest.fixture(scope="module")
def formats() -> dict:
    return runpy.run_path(str(ROOT / "docs" / "formats.py"))


def test_the_table_is_what_is_measured(formats: dict) -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert formats["with_table"](page) == page, "python docs/formats.py writes it anew"


def test_every_format_is_in_it(formats: dict) -> None:
    table = formats["TABLE"].search(PAGE.read_text(encoding="utf-8"))[0]
    for name in SUPPORTED.replace(", and", ",").replace(".vert/.tri", "").split(", "):
        assert f"| {name.strip()}" in table, name
