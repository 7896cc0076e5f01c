"""Landmarks in plain text: .pts, .vts, and bare coordinates (see the package for what each holds)."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from gmds.files.table import plain_number
from gmds.landmarks.files.named_points import BadLandmarkFile, Landmarks, Space, Specimens
from gmds.landmarks.files.reading import Rows, is_no_place, is_number, position, whole
from gmds.landmarks.files.table import parse_csv

Columns = Mapping[str, Sequence[object]]

COMMENTS = ("#", "//")  # CloudCompare's titles are one
HEADS = ("x", "name", "label", "id", "landmark")  # first words of a line of titles
IDAV_MISSING = [9999.0] * 3  # where IDAV Landmark, and Morpho after it, put what is missing


def parse_pts(path: Path, text: str, space: Space) -> Landmarks | Specimens:
    """Landmarks a line; a header of IDAV Landmark (`Version 1.0`, count) or of ibug (`version: 1`) is checked."""
    lines = [(number, line.split()) for number, line in enumerate(text.splitlines(), start=1) if line.strip()]
    count: int | None = None
    if lines and re.fullmatch(r"version:?", lines[0][1][0], re.IGNORECASE):
        count, lines = _below_header(path, lines)
    else:
        lines = [(number, words) for number, words in lines if not words[0].startswith(COMMENTS)]
        if lines and _is_table(" ".join(lines[0][1])):
            return parse_csv(path, text, space)
    rows = Rows(path)
    for number, words in lines:
        named = len(words) == 4
        at = position(path, number, words[named:])
        rows.add(f"line {number}", words[0] if named else None, None if at == IDAV_MISSING else at)
    if count is not None and count != len(lines):
        raise BadLandmarkFile(f"{path} declares {count} landmarks and holds {len(lines)}")
    return rows.landmarks()


def pts_text(landmarks: Landmarks, _: Space, __: Columns) -> str:
    """As IDAV Landmark writes it; blanks in names become `_`, as blanks separate."""
    rows = (
        f"{'_'.join(name.split())} {words_of(at)}"
        for name, at in zip(landmarks.names, landmarks.positions.tolist(), strict=True)
    )
    return "\n".join(["Version 1.0", str(len(landmarks)), *rows]) + "\n"


def parse_points(path: Path, text: str, space: Space) -> Landmarks | Specimens:
    """Three coordinates a line and perhaps a name before or behind them; or a table, when commas or tabs part it."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith(COMMENTS)]
    if lines and _is_table(lines[0]):
        return parse_csv(path, text, space)
    if lines and re.match(r"version", lines[0], re.IGNORECASE):
        return parse_pts(path, text, space)
    rows, counted = Rows(path), 0
    for number, line in enumerate(text.splitlines(), start=1):
        words = re.split("#|//", line, maxsplit=1)[0].split()
        if not words or (not rows.names and not counted and words[0].lower() in HEADS):
            continue
        if len(words) == 1 and not rows.names and not counted:
            counted = whole(path, number, words[0], least=1)
            continue
        first = len(words) == 4 and not (is_number(plain_number(words[0])) or is_no_place(words[0]))
        name = words[0] if first else words[3] if len(words) == 4 else None
        rows.add(f"line {number}", name, position(path, number, words[first : first + 3] if name else words))
    if counted not in (0, len(rows.names)):
        raise BadLandmarkFile(f"{path} declares {counted} landmarks and holds {len(rows.names)}")
    return rows.landmarks()


def _is_table(line: str) -> bool:
    """Whether cells of a line are parted by tabs, semicolons or commas, which are no decimal commas."""
    if "\t" in line or ";" in line:
        return True
    words = line.split()
    return "," in line and not (len(words) > 2 and all(is_number(plain_number(word)) for word in words[-3:]))


def parse_vts(path: Path, text: str, _: Space) -> Landmarks:
    """A vertex a line, from 1 in the file and from 0 here."""
    rows = Rows(path)
    for number, line in enumerate(text.splitlines(), start=1):
        if line.strip():
            rows.add(f"line {number}", None, None if is_no_place(line) else whole(path, number, line, least=1) - 1)
    return rows.landmarks()


def vts_text(landmarks: Landmarks, _: Space, __: Columns) -> str:
    """A vertex a line, from 1; names cannot be kept."""
    return "".join(f"{vertex + 1 if vertex >= 0 else 'NA'}\n" for vertex in landmarks.vertices)


def _below_header(path: Path, lines: list[tuple[int, list[str]]]) -> tuple[int, list[tuple[int, list[str]]]]:
    """The declared count, and the lines of the landmarks."""
    if len(lines) < 2:
        raise BadLandmarkFile(f"{path}, line {lines[0][0]}: the count of landmarks must follow")
    number, words = lines[1]
    if lines[0][1][0].endswith(":"):
        if words[0] != "n_points:" or len(words) != 2:
            raise BadLandmarkFile(f"{path}, line {number}: n_points: and a count must follow")
        if len(lines) < 4 or lines[2][1] != ["{"] or lines[-1][1] != ["}"]:
            raise BadLandmarkFile(f"{path}: the landmarks must stand between lines with {{ and }}")
        return whole(path, number, words[1]), lines[3:-1]
    return whole(path, number, " ".join(words)), lines[2:]


def words_of(at: Sequence[float]) -> str:
    """Coordinates with blanks between them; NA for what is missing."""
    return " ".join("NA" if math.isnan(x) else repr(x) for x in at)
