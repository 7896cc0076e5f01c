"""The gallery shows every example, says what its docstring says, and is made by its script."""

from __future__ import annotations

import ast
import re
import runpy
import sys
from pathlib import Path
from typing import Any

import pytest
from places import ROOT

pytest.importorskip("matplotlib")
PAGE = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
SCRIPT = ROOT / "docs" / "gallery.py"
LARGEST = 150_000  # bytes of a picture


@pytest.fixture
def gallery(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    monkeypatch.setattr(sys, "argv", ["gallery.py"])
    monkeypatch.syspath_prepend(str(SCRIPT.parent))
    return runpy.run_path(str(SCRIPT))


def test_every_example_has_its_place_and_a_small_picture(gallery: dict[str, Any]) -> None:
    scripts = {path.stem for path in (ROOT / "examples").glob("[0-9]*.py")}
    assert scripts | {"morphometrics/landmark_specimens"} == set(gallery["DRAWN"])
    for name in gallery["DRAWN"]:
        picture = f"gallery/{Path(name).name}.png"
        assert f"](../examples/{name}.py)" in PAGE and f"]({picture})" in PAGE, name
        assert 5_000 < (ROOT / "docs" / picture).stat().st_size < LARGEST, name


def test_it_says_of_each_script_what_the_script_says() -> None:
    described = re.findall(r"^\[\S+\]\(\.\./(\S+\.py)\): (.*)$", PAGE, re.MULTILINE)
    assert len(described) > 15
    for path, text in described:
        if "morphometrics" not in path:
            doc = ast.get_docstring(ast.parse((ROOT / path).read_text(encoding="utf-8"))) or ""
            assert text == doc.split("\n")[0]


@pytest.mark.parametrize("name", ["04_distances_and_voronoi", "08_arc_lengths"])
def test_a_picture_is_drawn_from_what_the_example_computed(gallery: dict[str, Any], name: str, tmp_path: Path) -> None:
    picture = gallery["draw"](name, tmp_path)
    assert picture.parent == tmp_path and 5_000 < picture.stat().st_size < LARGEST
