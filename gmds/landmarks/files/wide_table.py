"""Landmarks of a collection in a table with a row a specimen, as MorphoJ and others keep them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from gmds.files.table import plain_number, unguarded
from gmds.landmarks.files.named_points import BadLandmarkFile, Specimens, distinct
from gmds.landmarks.files.reading import Rows, is_no_place, is_number, position

TITLE = re.compile(  # of a coordinate: x1, X_1; 1.X, lm1x; nose_x, LM 1 (Y)
    r"(?P<axis>[xyz])[\W_]*(?P<number>\d+)|(?P<label>.*\d|.*\S(?=[\W_]))[\W_]*(?P<last>[xyz])[\W_]*", re.IGNORECASE
)
Wide = tuple[list[str], list[tuple[int, ...]]]  # names of landmarks, "" where they are numbers, and their columns


def columns_of_wide(cells: Sequence[str], headed: bool) -> Wide | None:
    """Where landmarks are, if a first row is that of a table of specimens: a label and 3 k > 3 coordinates a row.

    Titles say which column is which, in whatever order; there may be others among them.
    """
    if not headed:
        numbers = len(cells) >= 7 and len(cells) % 3 == 1
        if not numbers or not all(is_number(plain_number(cell)) or is_no_place(cell) for cell in cells[1:]):
            return None
        return [""] * (len(cells) // 3), [(i, i + 1, i + 2) for i in range(1, len(cells), 3)]
    places: dict[str, dict[str, int]] = {}
    for i, cell in enumerate(cells[1:], start=1):
        title = TITLE.fullmatch(cell.strip())
        if title is None:
            continue
        label = (title["number"] or title["label"]).strip(" ._-")
        axes = places.setdefault(label, {})
        if axes.setdefault((title["axis"] or title["last"]).lower(), i) != i:
            return None
    if len(places) < 2 or any(set(axes) != set("xyz") for axes in places.values()):
        return None
    names = ["" if label.isdecimal() else label for label in places]
    return names, [tuple(axes[axis] for axis in "xyz") for axes in places.values()]


def parse_wide(path: Path, table: Sequence[tuple[int, list[str]]], width: int, wide: Wide) -> Specimens:
    """The specimens of its rows, by label."""
    found = []
    for line, row in table:
        if len(row) != width:
            raise BadLandmarkFile(f"{path}, line {line}: {len(row)} entries where the first line has {width}")
        rows = Rows(path)
        for name, columns in zip(*wide, strict=True):
            rows.add(f"line {line}", name, position(path, line, [row[i] for i in columns]))
        found.append((unguarded(row[0]).strip(), rows))
    if not found:
        raise BadLandmarkFile(f"{path} holds no landmarks")
    names = distinct([name for name, _ in found])
    return {name: rows.landmarks() for name, (_, rows) in zip(names, found, strict=True)}
