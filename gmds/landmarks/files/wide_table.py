"""Landmarks of a collection in a table with a row a specimen, as MorphoJ and others keep them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from gmds.files.table import unguarded
from gmds.landmarks.files.named_points import BadLandmarkFile, Specimens, distinct
from gmds.landmarks.files.reading import Rows, is_no_place, is_number, plain_number, position

FIRST_AXES = re.compile(r"(x[\W_]?1|[^\d]*1[\W_]?x)", re.IGNORECASE)  # titles of the first coordinate: x1, 1.X, lm1.x


def is_wide(cells: Sequence[str], headed: bool) -> bool:
    """Whether the first row of a table is the header, or a row, of one with a label and 3 k > 3 coordinates a row."""
    if len(cells) < 7 or len(cells) % 3 != 1:
        return False
    if headed:
        return FIRST_AXES.fullmatch(cells[1].strip()) is not None
    return all(is_number(plain_number(cell)) or is_no_place(cell) for cell in cells[1:])


def parse_wide(path: Path, table: Sequence[tuple[int, list[str]]], width: int) -> Specimens:
    """The specimens of its rows, by label; landmarks have no names."""
    found = []
    for line, row in table:
        if len(row) != width:
            raise BadLandmarkFile(f"{path}, line {line}: {len(row)} entries where the first line has {width}")
        rows = Rows(path)
        for i in range(1, width, 3):
            rows.add(f"line {line}", None, position(path, line, row[i : i + 3]))
        found.append((unguarded(row[0]).strip(), rows))
    if not found:
        raise BadLandmarkFile(f"{path} holds no landmarks")
    names = distinct([name for name, _ in found])
    return {name: rows.landmarks() for name, (_, rows) in zip(names, found, strict=True)}
