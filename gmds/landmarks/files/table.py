"""Landmarks in a table, .csv (see the package for what it holds)."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from gmds.files.table import delimiter, plain_number, table_text, unguarded
from gmds.landmarks.files.named_points import SPACES, BadLandmarkFile, Landmarks, Space, Specimens, turned
from gmds.landmarks.files.reading import Rows, is_no_place, is_number, position, whole
from gmds.landmarks.files.wide_table import columns_of_wide, parse_wide

Columns = Mapping[str, Sequence[object]]

WORDS = {
    "name": ("name", "label", "landmark", ""),  # R writes the names of rows under no title
    "defined": ("defined",),
    "specimen": ("specimen",),
}
UNDEFINED = ("0", "false")
MISSING = "NA"  # what R, pandas and we read as a number that is missing
VERTICES = ("vertex", "index")
BARYCENTRIC = ("face", "w0", "w1", "w2")
ABOVE = re.compile(r"#|//|sep=.\s*$", re.IGNORECASE)  # comments, and what tells a spreadsheet what parts cells
UNIT = re.compile(r"\s*(\([^()]*\)|\[[^\[\]]*\])\s*$")  # behind a title


def parse_csv(path: Path, text: str, space: Space) -> Landmarks | Specimens:
    """Landmarks from a table, by specimen where it has several; without a header columns are as the package says."""
    table = _table(path, text)
    if not table:
        return Rows(path).landmarks()
    first, cells = table[0]
    headed = not (_is_place(cells[-1:]) or (len(cells) == 4 and _is_place(cells[:3])))
    width = len(cells)
    if wide := columns_of_wide(cells, headed):
        return parse_wide(path, table[headed:], width, wide)
    columns = _columns(path, first, cells) if headed else _usual_columns(path, first, cells)
    found: dict[str, Rows] = {}
    for line, row in table[headed:]:
        if len(row) != width:
            raise BadLandmarkFile(f"{path}, line {line}: {len(row)} entries where the first line has {width}")
        name = unguarded(row[columns["name"][0]]) if "name" in columns else None
        specimen = unguarded(row[columns["specimen"][0]]).strip() if "specimen" in columns else ""
        found.setdefault(specimen, Rows(path)).add(f"line {line}", name, _place(path, line, row, columns))
    axes = "".join(cells[i].strip() for i in columns.get("position", ())).upper() if headed else ""
    given = axes if axes in SPACES else space
    read = {specimen: rows.landmarks() for specimen, rows in (found or {"": Rows(path)}).items()}
    if "position" in columns:
        read = {
            specimen: replace(one, at=turned(one.at, given, space), framed=axes in SPACES)
            for specimen, one in read.items()
        }
    return read if "specimen" in columns else read[""]


def csv_text(landmarks: Landmarks, _: Space, columns: Columns) -> str:
    """A table with the header name,x,y,z, name,vertex or name,face,w0,w1,w2, then the further columns."""
    table = landmarks.at.reshape(len(landmarks), -1)
    titles = {1: ("vertex",), 3: ("x", "y", "z"), 4: BARYCENTRIC}[table.shape[1]]
    rows: list[list[object]] = [["name", *titles, *columns]]
    for i, (name, there) in enumerate(zip(landmarks.names, landmarks.defined, strict=True)):
        first, *others = table[i].tolist() if there else [MISSING] * len(titles)
        place = [int(first) if there and len(others) != 2 else first, *others]
        rows.append([name, *place, *(values[i] for values in columns.values())])
    return table_text(rows)


def _place(path: Path, line: int, row: list[str], columns: Mapping[str, tuple[int, ...]]) -> list[float] | int | None:
    """Where the landmark of a row is; None when it says that it is nowhere."""
    if "defined" in columns and row[columns["defined"][0]].strip().lower() in UNDEFINED:
        return None
    kind = next(kind for kind in ("vertex", "face", "position") if kind in columns)
    words = [row[i] for i in columns[kind]]
    if all(map(is_no_place, words)):
        return None
    if kind == "vertex":
        return whole(path, line, words[0])
    if kind == "face":
        weights = position(path, line, words[1:])
        return None if weights is None else [float(whole(path, line, words[0])), *weights]
    return position(path, line, words)


def _is_place(cells: Sequence[str]) -> bool:
    """Whether cells hold numbers, or words for those that are missing."""
    return all(is_number(plain_number(cell)) or is_no_place(cell) for cell in cells)


def _table(path: Path, text: str) -> list[tuple[int, list[str]]]:
    """Rows that are not empty, with their line, without empty columns at the end; comments above it are skipped."""
    lines = text.splitlines(keepends=True)
    skipped = next((i for i, line in enumerate(lines) if line.strip() and not ABOVE.match(line)), len(lines))
    body = "".join(lines[skipped:])
    head = body.split("\n", 1)[0]
    reader = csv.reader(io.StringIO(body), delimiter=delimiter(head), strict=True)
    try:
        table = [(skipped + reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    except csv.Error as error:
        raise BadLandmarkFile(f"{path}, line {skipped + reader.line_num}: {error}") from error
    while table and len({len(row) for _, row in table}) == 1 and not any(row[-1].strip() for _, row in table):
        table = [(line, row[:-1]) for line, row in table]
    return table


def _columns(path: Path, line: int, cells: list[str]) -> dict[str, tuple[int, ...]]:
    """Which columns hold what, by their titles."""
    titles = [UNIT.sub("", cell).strip().lower() for cell in cells]
    places = {key: _one_of(titles, words) for key, words in WORDS.items()}
    for axes in ("xyz", "lps", "ras"):
        if set(axes) <= set(titles):
            places["position"] = tuple(titles.index(axis) for axis in axes)
            break
    else:
        if set(BARYCENTRIC) <= set(titles):
            places["face"] = tuple(titles.index(title) for title in BARYCENTRIC)
        else:
            places["vertex"] = _one_of(titles, VERTICES)
    if not (places.get("position") or places.get("vertex") or places.get("face")):
        raise BadLandmarkFile(
            f"{path}, line {line}: a header needs the columns x, y, z (l, p, s; r, a, s), vertex, or face, w0, w1, w2"
        )
    return {key: columns for key, columns in places.items() if columns}


def _one_of(titles: list[str], wanted: tuple[str, ...]) -> tuple[int, ...]:
    return next(((titles.index(title),) for title in wanted if title in titles), ())


def _usual_columns(path: Path, line: int, cells: list[str]) -> dict[str, tuple[int, ...]]:
    """Which columns hold what, by their number; a name stands before or behind a place."""
    width = len(cells)
    if width == 4 and not _is_place(cells[3:]):
        return {"name": (3,), "position": (0, 1, 2)}
    usual: dict[int, dict[str, tuple[int, ...]]] = {
        1: {"vertex": (0,)},
        2: {"name": (0,), "vertex": (1,)},
        3: {"position": (0, 1, 2)},
        4: {"name": (0,), "position": (1, 2, 3)},
    }
    if width not in usual:
        raise BadLandmarkFile(f"{path}, line {line}: {width} entries; write name,x,y,z or name,vertex a line")
    return usual[width]
