"""Landmarks as 3D Slicer keeps them: markups (.mrk.json, schema 1.x) and fiducials (.fcsv, 4.x)."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from gmds.files.table import table_text, unguarded
from gmds.landmarks.files.named_points import (
    SPACES,
    BadLandmarkFile,
    Landmarks,
    PointList,
    Space,
    Status,
    turned,
)
from gmds.landmarks.files.reading import Rows, position

Columns = Mapping[str, Sequence[object]]

SCHEMA = (
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
    "markups-schema-v1.0.3.json#"
)
FCSV_COLUMNS = "id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID"
FCSV_SPACES = {"LPS": "LPS", "RAS": "RAS", "0": "RAS", "1": "LPS"}  # numbers until 4.10
OLDEST = re.compile(r"#\s*label:\s*x\s*,\s*y\s*,\s*z\s*,\s*sel\s*,\s*vis\s*", re.IGNORECASE)  # of 3D Slicer 3, in RAS
NOWHERE: dict[str, Status] = {"undefined": "undefined", "missing": "missing", "preview": "undefined"}  # positionStatus


def parse_mrk(path: Path, text: str, space: Space) -> Landmarks:
    """The control points of every list; a list that does not name its frame is in LPS, as the schema says."""
    try:
        content = json.loads(text)
    except json.JSONDecodeError as error:
        raise BadLandmarkFile(f"{path}, line {error.lineno}: not JSON ({error.msg})") from error
    except (RecursionError, ValueError) as error:
        raise BadLandmarkFile(f"{path} is not readable JSON ({error})") from error
    schema = content.get("@schema", "") if isinstance(content, dict) else None
    version = re.search(r"markups-schema-v(\d+)\.", schema) if isinstance(schema, str) else None
    known = schema == "" if version is None else version[1] == "1"
    if not known or not isinstance(content.get("markups"), list):
        raise BadLandmarkFile(f"{path} is not a markups file of schema 1.x (its @schema is {schema!r:.80})")
    rows = Rows(path)
    for i, markup in enumerate(content["markups"]):
        _read_markup(rows, f"markups[{i}]", markup, space)
    return replace(rows.landmarks(), framed=True)


def mrk_text(landmarks: Landmarks, space: Space, columns: Columns) -> str:
    """The lists that there are, curves as curves, or one of fiducials, in the frame `space`."""
    points: list[dict[str, Any]] = [
        {
            "id": str(i + 1),
            "label": name,
            "description": _described(columns, i),
            "position": np.nan_to_num(landmarks.positions[i]).tolist(),  # the schema wants numbers of all
            "selected": landmarks.selected[i],
            "locked": False,
            "visibility": True,
            "positionStatus": landmarks.status[i],
        }
        for i, name in enumerate(landmarks.names)
    ]
    markups, start = [], 0
    for one in landmarks.lists or (PointList("Fiducial", "", len(points)),):
        named = {"name": one.name} if one.name else {}
        some = points[start : start + one.size]
        markups.append({"type": one.kind, **named, "coordinateSystem": space, "controlPoints": some})
        start += one.size
    return json.dumps({"@schema": SCHEMA, "markups": markups}, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def parse_fcsv(path: Path, text: str, space: Space) -> Landmarks:
    """Fiducials; the header must say which frame they are in."""
    given: str | None = None
    titles = FCSV_COLUMNS.split(",")
    rows, places = Rows(path), []
    for number, line in enumerate(text.splitlines(), start=1):
        if line.startswith("#"):
            if OLDEST.fullmatch(line):
                titles, given = ["label", "x", "y", "z", "sel", "vis"], given or "RAS"
            key, _, value = (part.strip() for part in line[1:].partition("="))
            if key.lower() == "coordinatesystem":
                given = _fcsv_space(path, number, value, given)
            elif key.lower() == "columns":
                titles = [title.strip() for title in value.split(",")]
                if not {"x", "y", "z", "label"} <= set(titles):
                    raise BadLandmarkFile(f"{path}, line {number}: the columns must hold x, y, z and label")
        elif line.strip():
            places.append((number, _fcsv_cells(path, number, line, titles)))
    if given is None:
        raise BadLandmarkFile(f"{path} does not say its frame; add the line `# CoordinateSystem = LPS` (or RAS)")
    for number, cells in places:
        at = position(path, number, [cells[axis] for axis in "xyz"])
        rows.add(f"line {number}", unguarded(cells["label"]), at)
    landmarks = rows.landmarks()
    return replace(landmarks, at=turned(landmarks.at, given, space), framed=True)


def fcsv_text(landmarks: Landmarks, space: Space, columns: Columns) -> str:
    """Fiducials in the frame `space`, one a line; the format has no word for one without a place: left out."""
    head = f"# Markups fiducial file version = 4.13\n# CoordinateSystem = {space}\n# columns = {FCSV_COLUMNS}\n"
    rows: list[list[object]] = []
    for i in np.flatnonzero(landmarks.defined).tolist():
        label = " ".join(landmarks.names[i].split())
        place = landmarks.positions[i].tolist()
        rows.append([i + 1, *place, 0, 0, 0, 1, 1, 1, 0, label, _described(columns, i), ""])
    return head + table_text(rows)


def _read_markup(rows: Rows, where: str, markup: Any, space: Space) -> None:
    def refuse(what: str) -> NoReturn:
        raise BadLandmarkFile(f"{rows.path}, {where}: {what}")

    if not isinstance(markup, dict) or not isinstance(markup.get("controlPoints", []), list):
        refuse("no list of controlPoints")
    if markup.get("type") == "ROI":  # a box, whose one control point is its middle
        return
    given = markup.get("coordinateSystem", "LPS")
    if given not in SPACES:
        refuse(f"coordinateSystem is {given!r:.40}, not LPS or RAS")
    kind, name = markup.get("type", "Fiducial"), markup.get("name", "")
    if not isinstance(kind, str) or not isinstance(name, str):
        refuse("type and name must be text")
    rows.lists.append(PointList(kind, name, len(markup.get("controlPoints", []))))
    for i, point in enumerate(markup.get("controlPoints", [])):
        place = f"{where}.controlPoints[{i}]"
        if not isinstance(point, dict):
            refuse(f"controlPoints[{i}] is no object")
        label = point.get("label", "")
        if not isinstance(label, str):
            refuse(f"controlPoints[{i}]: the label is no text")
        status = point.get("positionStatus", "defined")
        selected = point.get("selected", True) is not False
        if isinstance(status, str) and status in NOWHERE:
            rows.add(place, label, None, NOWHERE[status], selected=selected)
            continue
        at: Any = point.get("position")
        if not _is_position(at):
            refuse(f"controlPoints[{i}] ({label!r:.40}): the position must be three finite numbers")
        sign = 1.0 if given == space else -1.0  # as in `turned`
        rows.add(place, label, [sign * at[0], sign * at[1], float(at[2])], selected=selected)


def _is_position(at: Any) -> bool:
    plain = isinstance(at, list) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in at)
    return plain and len(at) == 3 and all(abs(x) <= 1e308 for x in at)  # NaN compares false


def _fcsv_space(path: Path, number: int, value: str, before: str | None) -> str:
    given = FCSV_SPACES.get(value.upper())
    if given is None or before not in (None, given):
        raise BadLandmarkFile(f"{path}, line {number}: the frame is {value[:40]!r}; LPS or RAS, one for the whole file")
    return given


def _fcsv_cells(path: Path, number: int, line: str, titles: list[str]) -> dict[str, str]:
    try:
        cells = next(csv.reader([line], strict=True))
    except csv.Error as error:
        raise BadLandmarkFile(f"{path}, line {number}: {error}") from error
    needed = max(titles.index(title) for title in ("x", "y", "z", "label")) + 1
    if len(cells) < needed:
        raise BadLandmarkFile(f"{path}, line {number}: {len(cells)} entries; its columns need at least {needed}")
    return dict(zip(titles, cells, strict=False))


def _described(columns: Columns, i: int) -> str:
    return ", ".join(f"{title} {values[i]}" for title, values in columns.items())
