"""The page of a map that the documentation holds in a frame is made from the kept map when the site is built."""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import Any

import pytest
from pages import page_data
from places import ROOT

from gmds import Correspondence


@pytest.fixture(scope="module")
def live() -> dict[str, Any]:
    return runpy.run_path(str(ROOT / "docs" / "live.py"))


def test_the_frame_shows_the_map_with_its_errors(live: dict[str, Any], tmp_path: Path) -> None:
    page = tmp_path / "live" / "map.html"
    live["write_page"](page)
    modes = {mode["key"] for mode in page_data(page)["modes"]}
    assert {"match", "confidence", "distortion", "growth", "error"} <= modes
    assert 100_000 < page.stat().st_size < 500_000
    assert f'src="../{page.relative_to(tmp_path)}"' in (ROOT / "docs" / "howto" / "looking.md").read_text("utf-8")


def test_the_kept_map_is_one_that_match_made(live: dict[str, Any]) -> None:
    source, target, _ = live["pair"]()
    kept = Correspondence.load(live["KEPT"], source, target)
    assert kept.status.name == "GOOD" and kept.confidence.mean() > 0.8 and kept.meta["versions"]
