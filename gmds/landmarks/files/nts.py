"""Landmarks in NTSYS files (.nts, and .dta as IDAV Landmark writes them)."""

from __future__ import annotations

import re
from pathlib import Path

from gmds.files.table import plain_number
from gmds.landmarks.files.named_points import BadLandmarkFile, Landmarks, Space, Specimens, distinct
from gmds.landmarks.files.reading import Rows, is_number, position

PARAMETERS = re.compile(r"1\s+(\d{1,9})(L?)\s+(\d{1,9})(L?)\s+(?:0|1\s+(\S+))(?:\s+dim\s*=\s*(\d+))?\s*", re.IGNORECASE)


def parse_nts(path: Path, text: str, _: Space) -> Landmarks | Specimens:
    """A matrix with a row a specimen, or, of one surface, with a row a landmark."""
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith(('"', "'"))
    ]
    head = PARAMETERS.fullmatch(lines[0][1].strip()) if lines else None
    if head is None:
        raise BadLandmarkFile(f"{path} has no parameter line of NTSYS, as 1 rows columns 0 DIM=3")
    count, width, absent = int(head[1]), int(head[3]), head[5]
    if head[6] not in (None, "3"):
        raise BadLandmarkFile(f"{path}, line {lines[0][0]}: landmarks in {head[6]} dimensions; surfaces have 3")
    words = [(number, word) for number, line in lines[1:] for word in line.split()]
    labels = [word for _, word in words[: count if head[2] else 0]]
    words = words[len(labels) :]
    titles = [word for _, word in words[: width if head[4] else 0]]
    numbers = words[len(titles) :]
    single = width == 3 or (len(numbers) != count * width and len(numbers) == width)
    expected = (3 * count if width == 3 else width) if single else count * width
    if len(numbers) != expected or width % 3 or not numbers:
        raise BadLandmarkFile(f"{path}: {len(numbers)} numbers where {count} times {width} are declared")
    cells = [(line, "NA" if _same(word, absent) else word) for line, word in numbers]
    if single:
        return _landmarks(path, cells, labels)
    names = distinct(labels or [str(i + 1) for i in range(count)])
    return {name: _landmarks(path, cells[i * width : (i + 1) * width], []) for i, name in enumerate(names)}


def _landmarks(path: Path, cells: list[tuple[int, str]], labels: list[str]) -> Landmarks:
    rows, count = Rows(path), len(cells) // 3
    for i in range(count):
        line, place = cells[3 * i][0], [word for _, word in cells[3 * i : 3 * i + 3]]
        rows.add(f"line {line}", labels[i] if len(labels) == count else None, position(path, line, place))
    return rows.landmarks()


def _same(word: str, absent: str | None) -> bool:
    """Whether a number is the one that stands for what is missing."""
    word, absent = plain_number(word), plain_number(absent or "")
    return is_number(word) and is_number(absent) and float(word) == float(absent)
