"""Landmarks in a table, .csv (see the package for what it holds)."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path

from gmds.files.table import table_text, unguarded
from gmds.landmarks.files.named_points import SPACES, BadLandmarkFile, Landmarks, Space, turned
from gmds.landmarks.files.reading import Rows, is_number, position, whole

Columns = Mapping[str, Sequence[object]]

NAMES = ("name", "label", "landmark")
VERTICES = ("vertex", "index")
BARYCENTRIC = ("face", "w0", "w1", "w2")


def parse_csv(path: Path, text: str, space: Space) -> Landmarks:
    """Landmarks from a table; without a header the columns are as the package says."""
    table = _table(path, text)
    if not table:
        return Rows(path).landmarks()
    first, cells = table[0]
    headed = not is_number(cells[-1])
    width = len(cells)
    columns = _columns(path, first, cells) if headed else _usual_columns(path, first, width)
    rows = Rows(path)
    for line, row in table[headed:]:
        if len(row) != width:
            raise BadLandmarkFile(f"{path}, line {line}: {len(row)} entries where the first line has {width}")
        name = unguarded(row[columns["name"][0]]) if "name" in columns else None
        at: list[float] | int | None = None
        if "vertex" in columns:
            at = whole(path, line, row[columns["vertex"][0]])
        elif "face" in columns:
            face, *weights = (row[i] for i in columns["face"])
            at = [float(whole(path, line, face)), *position(path, line, weights)]
        elif "defined" not in columns or row[columns["defined"][0]].strip() != "0":
            at = position(path, line, [row[i] for i in columns["position"]])
        rows.add(f"line {line}", name, at)
    landmarks = rows.landmarks()
    if "position" not in columns:
        return landmarks
    axes = "".join(cells[i].strip() for i in columns["position"]).upper() if headed else ""
    given = axes if axes in SPACES else space
    return Landmarks(landmarks.names, turned(landmarks.at, given, space), landmarks.named, landmarks.missing)


def csv_text(landmarks: Landmarks, _: Space, columns: Columns) -> str:
    """A table with the header name,x,y,z, name,vertex or name,face,w0,w1,w2, then the further columns."""
    table = landmarks.at.reshape(len(landmarks), -1)
    titles = {1: ("vertex",), 3: ("x", "y", "z"), 4: BARYCENTRIC}[table.shape[1]]
    rows: list[list[object]] = [["name", *titles, *columns]]
    for i, name in enumerate(landmarks.names):
        first, *others = table[i].tolist()
        place = [first if len(others) == 2 else int(first), *others]
        rows.append([name, *place, *(values[i] for values in columns.values())])
    return table_text(rows)


def _table(path: Path, text: str) -> list[tuple[int, list[str]]]:
    """Rows that are not empty, with their line; lines that begin with # are skipped above the table."""
    lines = text.splitlines(keepends=True)
    skipped = next((i for i, line in enumerate(lines) if line.strip() and not line.startswith("#")), len(lines))
    body = "".join(lines[skipped:])
    head = body.split("\n", 1)[0]
    reader = csv.reader(io.StringIO(body), delimiter=next((d for d in ",;\t" if d in head), ","), strict=True)
    try:
        return [(skipped + reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    except csv.Error as error:
        raise BadLandmarkFile(f"{path}, line {skipped + reader.line_num}: {error}") from error


def _columns(path: Path, line: int, cells: list[str]) -> dict[str, tuple[int, ...]]:
    """Which columns hold what, by their titles."""
    titles = [cell.strip().lower() for cell in cells]
    places = {"name": _one_of(titles, NAMES), "defined": _one_of(titles, ("defined",))}
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


def _usual_columns(path: Path, line: int, width: int) -> dict[str, tuple[int, ...]]:
    """Which columns hold what, by their number."""
    usual: dict[int, dict[str, tuple[int, ...]]] = {
        1: {"vertex": (0,)},
        2: {"name": (0,), "vertex": (1,)},
        3: {"position": (0, 1, 2)},
        4: {"name": (0,), "position": (1, 2, 3)},
    }
    if width not in usual:
        raise BadLandmarkFile(f"{path}, line {line}: {width} entries; write name,x,y,z or name,vertex a line")
    return usual[width]
