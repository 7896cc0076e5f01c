"""The words and tables of the page, as HTML in which nothing that comes from outside is markup."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable, Mapping
from typing import Any

from gmds.maps.npz_format import fingerprint
from gmds.maps.point_map import PointMap
from gmds.maps.words import WORDS

Rows = list[tuple[str, str]]
Card = tuple[str, str, str]  # a figure, what it is, and which of `WORDS` that is of, if of any

GENERAL = (
    "Drag to turn, scroll to zoom, Shift and drag to move. With fingers: sideways turns, up and down scrolls the page, "
    "two zoom and move. With the keyboard: Tab to a surface, then arrow keys, plus and minus.",
    "Point at a surface, and the partner lights up on the other. A dashed ring is a partner on the far side. Every "
    "click keeps one more pair marked while you turn; Escape lets all of them go.",
    "Grey has no counterpart, or no value. Scales are the same on every page, so that two pages can be compared, "
    'unless "to 0.1" or "fit scale" is ticked: these end where good maps do, or 98 % of the values of this map.',
    "The length at the lower right of a surface is in the units of its file, and holds in the middle of the view.",
)


def cards(rows: Iterable[Card]) -> str:
    """The few figures that matter most, as items of a list, each with a question mark at what it is of."""
    return "".join(
        f"<li><b>{html.escape(value)}</b><span>{html.escape(name)}{about(word) if word else ''}</span></li>"
        for value, name, word in rows
    )


def advice(next_step: str) -> str:
    """What to do next, and how the page is used."""
    first, *rest = (html.escape(sentence) for sentence in (next_step, *GENERAL))
    return f'<ul><li id="next">{first}</li>{"".join(f"<li>{sentence}</li>" for sentence in rest)}</ul>'


def about(word: str) -> str:
    """A question mark that says what a word means."""
    meaning = html.escape(WORDS[word])
    return f'<abbr class="about" title="{meaning}" aria-label="{meaning}" tabindex="0"></abbr>'


def words() -> str:
    """The words of the page and what they mean, as items of a list of definitions."""
    return "".join(f"<dt>{word}</dt><dd>{html.escape(meaning)}</dd>" for word, meaning in WORDS.items())


def made(answer: PointMap) -> str:
    """Parameters, versions and all else that the map says of its making, and the contents of both meshes, as rows."""
    rows = list(_flat(answer.meta))
    for name, mesh in (("source", answer.source), ("target", answer.target)):
        rows.append((f"{name}: SHA-256 of its contents", str(fingerprint(mesh)["sha256"])))
    return table_rows(rows)


def table_rows(rows: Iterable[tuple[str, str]]) -> str:
    """Rows of a table with a name and a value each."""
    return "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>" for name, value in rows)


def _flat(meta: Mapping[str, Any], prefix: str = "") -> Iterable[tuple[str, str]]:
    """Nested settings as (path, value)."""
    for key, value in meta.items():
        name = f"{prefix}{key}".replace("_", " ")
        if isinstance(value, Mapping):
            yield from _flat(value, f"{name}: ")
        else:
            told = value if isinstance(value, str) else f"{value:.6g}" if isinstance(value, float) else None
            yield name, json.dumps(value, default=str) if told is None else told


def choices(modes: Iterable[tuple[str, str]]) -> str:
    """Radio buttons for the ways of colouring, the first one chosen."""
    buttons = (
        f'<label><input type="radio" name="mode" value="{html.escape(key)}">{html.escape(label)}</label>'
        for key, label in modes
    )
    return "".join(buttons).replace("<input", "<input checked", 1)


def swatches(colours: Iterable[tuple[str, str]]) -> str:
    """A legend of single colours, each with what it means."""
    shown = '<span class="swatch" style="background:{}"></span>{}'
    return "".join(shown.format(colour, html.escape(text)) for colour, text in colours)
