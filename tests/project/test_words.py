"""The words by which a map is judged are defined once; whoever says what they mean quotes that."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from places import ROOT

from gmds.maps.words import WORDS

# what a definition of the word would say in other words
SECOND = {
    "confidence": r"probab\w+[^.|]{0,90}0\.05|0\.05[^.|]{0,60}probab",
    "distortion": r"(what|the) share (by which )?lengths|relative (change|error) of lengths",
    "stress": r"mean difference between distances|between distances on the source and",
    "orientation": r"share of (the|its)[^.]{0,40}area[^.]{0,60}keeps? (the|its|their) orientation",
    "status": r"[Hh]ow far (the whole|a|the) map (as a whole )?can be trusted",
    "error": r"sent from its true place|where (it|a vertex) should go, over",
}
OWN = ROOT / "gmds" / "maps" / "words.py"


def plain(text: str) -> str:
    """Text without line breaks and the marks of Markdown."""
    return re.sub(r"\s+", " ", re.sub(r"[`*]", "", text))


def prose() -> dict[str, str]:
    """What people read: pages, docstrings, texts in code, the page of a map."""
    found = {}
    pages = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    code = [path for package in ("geodesics", "gmds") for path in sorted((ROOT / package).rglob("*.py"))]
    assets = [path for path in (ROOT / "gmds").rglob("*") if path.suffix in (".html", ".js")]
    for path in [*pages, *assets]:
        found[str(path.relative_to(ROOT))] = plain(path.read_text(encoding="utf-8"))
    for path in code:
        if path == OWN:
            continue
        texts = [
            node.value
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Constant) and isinstance(node.value, str)
        ]
        found[str(path.relative_to(ROOT))] = plain(" ¶ ".join(texts))
    return found


@pytest.fixture(scope="module")
def texts() -> dict[str, str]:
    return prose()


@pytest.mark.parametrize("word", SECOND)
def test_no_second_definition_appears(word: str, texts: dict[str, str]) -> None:
    second = {
        name: text[max(hit.start() - 60, 0) : hit.end() + 40]
        for name, text in texts.items()
        for hit in re.finditer(SECOND[word], text.replace(plain(WORDS[word]), ""))
    }
    assert not second


@pytest.mark.parametrize("word", SECOND)
def test_the_one_definition_would_be_seen_as_one(word: str) -> None:
    assert re.search(SECOND[word], plain(WORDS[word])), "else a copy in slightly other words would pass"


@pytest.mark.parametrize("word", SECOND)
def test_it_is_quoted_where_people_look(word: str, texts: dict[str, str]) -> None:
    quoted = [name for name, text in texts.items() if plain(WORDS[word]) in text]
    assert "docs/concepts.md" in quoted
    assert word == "error" or any(Path(name).suffix == ".py" for name in quoted), "a docstring"
