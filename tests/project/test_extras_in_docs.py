"""Pages name the extra that a command needs before the first block that uses it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from places import ROOT

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
BLOCK = re.compile(r"^```(?:sh|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NEEDS = {
    "batch": re.compile(r"^gmds (?:batch|atlas|landmarks \S+ --template)\b", re.MULTILINE),
    "repair": re.compile(r"^gmds repair .*--(?:fill-holes|remesh)\b", re.MULTILINE),
}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_the_extra_is_named_before_what_needs_it(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for extra, command in NEEDS.items():
        uses = [block for block in BLOCK.finditer(text) if command.search(block.group(1))]
        if uses:
            before = text[: uses[0].start()] + uses[0].group(1).split("gmds")[0]
            assert re.search(rf"\[(?:\w+,)*{extra}\]|`{extra}`", before), f"{extra} is not named"
