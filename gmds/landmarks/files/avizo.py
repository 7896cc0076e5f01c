"""Landmark sets of Avizo and Amira, as text (.landmarkAscii)."""

from __future__ import annotations

import re
from pathlib import Path

from gmds.landmarks.files.named_points import BadLandmarkFile, Landmarks, Space, Specimens
from gmds.landmarks.files.reading import Rows, position

SET = re.compile(r"Markers\s*\{\s*(?:float|double)\[3\]\s*\w+\s*\}\s*(?:=\s*)?@(\d{1,4})", re.IGNORECASE)
COUNT = re.compile(r"define\s+Markers\s+(\d{1,9})", re.IGNORECASE)


def parse_avizo(path: Path, text: str, _: Space) -> Landmarks | Specimens:
    """The landmarks; of a file with several sets, those of each, called 1, 2, ..."""
    lines = text.splitlines()
    head = next((line for line in lines if line.strip()), "")
    if not re.match(r"#\s*(Avizo|AmiraMesh|HyperMesh|HyperSurface).*ASCII", head, re.IGNORECASE):
        raise BadLandmarkFile(f"{path} does not begin as a text file of Avizo or Amira; save it as Ascii")
    count, sets = COUNT.search(text), SET.findall(text)
    if count is None or not sets:
        raise BadLandmarkFile(f"{path} is no landmark set; it needs `define Markers` and `Markers {{ float[3] ... }}`")
    found = {str(i): _section(path, lines, mark, int(count[1])) for i, mark in enumerate(dict.fromkeys(sets), start=1)}
    return found["1"] if len(found) == 1 else found


def _section(path: Path, lines: list[str], mark: str, count: int) -> Landmarks:
    start = next((i for i, line in enumerate(lines) if line.strip() == f"@{mark}"), None)
    if start is None:
        raise BadLandmarkFile(f"{path} has no data section @{mark}")
    rows = Rows(path)
    for number, line in enumerate(lines[start + 1 :], start=start + 2):
        if line.strip().startswith("@") or len(rows.names) == count:
            break
        if line.strip() and not line.strip().startswith("#"):
            rows.add(f"line {number}", None, position(path, number, line.split()))
    if len(rows.names) != count:
        raise BadLandmarkFile(f"{path} declares {count} landmarks and section @{mark} holds {len(rows.names)}")
    return rows.landmarks()
