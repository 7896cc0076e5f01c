"""Landmarks in plain text: .pts, .tps and .vts (see the package for what each holds)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from gmds.landmarks.files.named_points import BadLandmarkFile, Landmarks, Space
from gmds.landmarks.files.reading import Rows, is_number, position, whole

Columns = Mapping[str, Sequence[object]]


def parse_pts(path: Path, text: str, _: Space) -> Landmarks:
    """Landmarks a line; a header of IDAV Landmark (`Version 1.0`, count) or of ibug (`version: 1`) is checked."""
    lines = [(number, line.split()) for number, line in enumerate(text.splitlines(), start=1) if line.strip()]
    count: int | None = None
    if lines and re.fullmatch(r"version:?", lines[0][1][0], re.IGNORECASE):
        count, lines = _below_header(path, lines)
    else:
        lines = [(number, words) for number, words in lines if not words[0].startswith("#")]
    rows = Rows(path)
    for number, words in lines:
        named = len(words) == 4
        rows.add(f"line {number}", words[0] if named else None, position(path, number, words[named:]))
    if count is not None and count != len(lines):
        raise BadLandmarkFile(f"{path} declares {count} landmarks and holds {len(lines)}")
    return rows.landmarks()


def pts_text(landmarks: Landmarks, _: Space, __: Columns) -> str:
    """As IDAV Landmark writes it; blanks in names become `_`, as blanks separate."""
    rows = (f"{'_'.join(name.split())} {_words(at)}" for name, at in _placed(landmarks))
    return "\n".join(["Version 1.0", str(len(landmarks)), *rows]) + "\n"


def parse_tps(path: Path, text: str, _: Space) -> Landmarks:
    """The landmarks of the one specimen of a TPS file."""
    lines = [(number, line.strip()) for number, line in enumerate(text.splitlines(), start=1) if line.strip()]
    if not lines or not (head := re.fullmatch(r"LM3\s*=\s*(\S+)", lines[0][1], re.IGNORECASE)):
        where = f", line {lines[0][0]}: {lines[0][1][:40]!r}" if lines else " is empty"
        raise BadLandmarkFile(f"{path}{where}; a TPS file of landmarks in space begins with LM3=count")
    count = whole(path, lines[0][0], head[1])
    rows = Rows(path)
    for number, line in lines[1 : count + 1]:
        rows.add(f"line {number}", None, position(path, number, line.split()))
    if len(rows.names) != count:
        raise BadLandmarkFile(f"{path} declares {count} landmarks and holds {len(rows.names)}")
    for number, line in lines[count + 1 :]:
        _check_tps_key(path, number, line)
    return rows.landmarks()


def tps_text(landmarks: Landmarks, _: Space, __: Columns) -> str:
    """One specimen; names cannot be kept."""
    return "\n".join([f"LM3={len(landmarks)}", *(_words(at) for _, at in _placed(landmarks)), "ID=0"]) + "\n"


def parse_vts(path: Path, text: str, _: Space) -> Landmarks:
    """A vertex a line, from 1 in the file and from 0 here."""
    rows = Rows(path)
    for number, line in enumerate(text.splitlines(), start=1):
        if line.strip():
            rows.add(f"line {number}", None, whole(path, number, line, least=1) - 1)
    return rows.landmarks()


def vts_text(landmarks: Landmarks, _: Space, __: Columns) -> str:
    """A vertex a line, from 1; names cannot be kept."""
    return "".join(f"{vertex + 1}\n" for vertex in landmarks.vertices)


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


def _check_tps_key(path: Path, number: int, line: str) -> None:
    key, equals, value = (part.strip() for part in line.partition("="))
    if not equals:
        raise BadLandmarkFile(f"{path}, line {number}: {line[:40]!r} is one more line than LM3= declares")
    if key.upper() in ("LM3", "LM"):
        raise BadLandmarkFile(f"{path}, line {number}: a second specimen; keep one a file, as its surface")
    if key.upper().startswith(("CURVES", "POINTS")) and value != "0":
        raise BadLandmarkFile(f"{path}, line {number}: curves are not read; keep their points as landmarks")
    if key.upper() == "SCALE" and not (is_number(value) and float(value) == 1):
        raise BadLandmarkFile(f"{path}, line {number}: a scale other than 1; give positions as the mesh has them")


def _placed(landmarks: Landmarks) -> Iterator[tuple[str, list[float]]]:
    return zip(landmarks.names, landmarks.positions.tolist(), strict=True)


def _words(at: list[float]) -> str:
    return " ".join(map(repr, at))
