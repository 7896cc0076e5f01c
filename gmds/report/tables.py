"""The words and tables of the page, as HTML in which nothing that comes from outside is markup."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from geodesics.arrays import Floats
from gmds.evaluation import summary
from gmds.maps.npz_format import fingerprint
from gmds.maps.overlap import overlap
from gmds.maps.point_map import MatchStatus, PointMap

Rows = list[tuple[str, str]]

VERDICTS = {
    MatchStatus.GOOD: ("good", "Trustworthy"),
    MatchStatus.AMBIGUOUS: ("fair", "Two answers"),
    MatchStatus.UNRATED: ("plain", "Not rated"),
    MatchStatus.POOR: ("poor", "Doubtful"),
}
NEXT = {
    MatchStatus.GOOD: "Check a few places that you know (tips of limbs, eyes, joints): point at them and see where "
    "their partner lights up.",
    MatchStatus.AMBIGUOUS: "Compare the best map with the candidates (the list above the surfaces): of maps that do "
    "about as well, often one has left and right exchanged. Two or three landmarks settle which is right.",
    MatchStatus.UNRATED: "Nothing is known of how good this map is. Check it where you know the answer.",
    MatchStatus.POOR: "Do not use this map before you have looked at it closely. Try the candidates; give a few "
    "landmarks; see whether the two surfaces are of the same kind.",
}
GENERAL = (
    "Drag to turn, scroll or pinch to zoom. With the keyboard: Tab to a surface, then arrow keys, plus and minus.",
    "Point at a surface, and the partner lights up on the other. A dashed ring is a partner on the far side. A click "
    "keeps a pair marked while you turn; Escape lets it go.",
    "Grey has no counterpart, or no value.",
)


def cards(answer: PointMap, errors: Floats | None) -> str:
    """The few figures that matter most, as items of a list."""
    valid = answer.valid
    found: Rows = [(f"{100 * valid.mean():.1f} %", "of the source has a counterpart")]
    if valid.any() and np.ptp(answer.distortion) > 0:
        found.append((f"{np.median(answer.distortion[valid]):.3g}", "median distortion"))
    if answer.candidates:
        found.append((str(len(answer.candidates)), "other maps to compare"))
    for name, value in _judged(errors)[:2]:
        found.append((value, name))
    return "".join(f"<li><b>{html.escape(value)}</b><span>{html.escape(name)}</span></li>" for value, name in found)


def advice(answer: PointMap) -> str:
    """What to do next, and how the page is used."""
    sentences = (NEXT[answer.status], *GENERAL)
    return f"<ul>{''.join(f'<li>{html.escape(sentence)}</li>' for sentence in sentences)}</ul>"


def facts(answer: PointMap, errors: Floats | None, *, shares: bool = True) -> str:
    """Counts, what has a counterpart, distortion, and errors by the protocol, as rows of a table.

    `shares`: whether to tell how much of the area of both is matched, which takes 2 s for 100,000 vertices.
    """
    valid = answer.valid
    rows = [
        ("vertices, faces of the source", f"{answer.source.n_vertices:,}, {answer.source.n_faces:,}"),
        ("vertices, faces of the target", f"{answer.target.n_vertices:,}, {answer.target.n_faces:,}"),
        ("source vertices with a counterpart", f"{int(valid.sum()):,}, {100 * valid.mean():.1f} %"),
    ]
    if shares:
        ours, theirs = (f"{100 * share:.1f} %" for share in overlap(answer))
        rows.append(("area with a counterpart, of the source and of the target", f"{ours}, {theirs}"))
    if valid.any() and np.ptp(answer.distortion) > 0:
        middle, most = np.median(answer.distortion[valid]), answer.distortion[valid].max()
        rows.append(("distortion, median and largest", f"{middle:.4g}, {most:.4g}"))
    return table_rows([*rows, *_judged(errors)])


def made(answer: PointMap) -> str:
    """Parameters, versions and all else that the map says of its making, and the contents of both meshes, as rows."""
    rows = list(_flat(answer.meta))
    for name, mesh in (("source", answer.source), ("target", answer.target)):
        rows.append((f"{name}: SHA-256 of its contents", str(fingerprint(mesh)["sha256"])))
    return table_rows(rows)


def table_rows(rows: Iterable[tuple[str, str]]) -> str:
    """Rows of a table with a name and a value each."""
    return "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>" for name, value in rows)


def _judged(errors: Floats | None) -> Rows:
    """The errors (k, n) of the best map by the protocol of the field; no rows without truth."""
    known = errors[0][np.isfinite(errors[0])] if errors is not None else np.empty(0)
    if len(known) == 0:
        return []
    found = summary(known)
    return [
        ("mean error x100", f"{found.mean:.2f}"),
        ("of points within 0.10 of the truth", f"{found.within_010:.1f} %"),
        ("of points within 0.05", f"{found.within_005:.1f} %"),
        ("of points within 0.25", f"{found.within_025:.1f} %"),
        ("points with known truth", f"{found.count:,}"),
    ]


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
