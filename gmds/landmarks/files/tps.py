"""Landmarks in TPS files (Rohlf): specimens one after the other, each `LM3=count`, its landmarks, further keys."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path, PureWindowsPath

from gmds.files.table import plain_number
from gmds.landmarks.files.named_points import BadLandmarkFile, Landmarks, Space, Specimens, distinct
from gmds.landmarks.files.plain import words_of
from gmds.landmarks.files.reading import Rows, is_number, position, whole

LANDMARKS = ("LM3", "LM")
NUMBERS = ("", "SCALE", "CURVES", "POINTS", "POINTS3", *LANDMARKS)  # keys of numbers, and coordinates themselves
COMMENTS = ("#", '"', "'", "//")
Line = tuple[int, str, str]  # its number, the key, the value; coordinates have an empty key


def parse_tps(path: Path, text: str, _: Space) -> Specimens:
    """Every specimen, by its ID, else its image, else its number; SCALE multiplies, points of curves follow."""
    blocks: list[list[Line]] = []
    for number, key, value in _lines(text):
        if key in LANDMARKS:
            blocks.append([])
        if not blocks and not key:
            raise BadLandmarkFile(f"{path}, line {number}: {value[:40]!r}; a specimen in space begins with LM3=count")
        if blocks:
            blocks[-1].append((number, key, value))
    if not blocks:
        raise BadLandmarkFile(f"{path} holds no landmarks; a specimen in space begins with LM3=count")
    names = distinct([_name(block) or str(i) for i, block in enumerate(blocks, start=1)])
    return {name: _specimen(path, block) for name, block in zip(names, blocks, strict=True)}


def tps_text(landmarks: Landmarks, _: Space, __: Mapping[str, Sequence[object]]) -> str:
    """One specimen; names cannot be kept."""
    return "\n".join([f"LM3={len(landmarks)}", *map(words_of, landmarks.positions.tolist()), "ID=0"]) + "\n"


def _lines(text: str) -> Iterator[Line]:
    """Lines with a key or with coordinates, but for comments."""
    for number, line in enumerate(text.splitlines(), start=1):
        line = line.strip()
        if not line or line.startswith(COMMENTS):
            continue
        key, equals, value = line.partition("=")
        key, value = (key.strip().upper(), value.strip()) if equals else ("", line)
        if key in NUMBERS:  # text may hold the mark of a comment, numbers cannot
            value = value.partition("#")[0].strip()
        yield number, key, value


def _name(block: Sequence[Line]) -> str:
    """The ID of a specimen, or the stem of its image; tpsDig numbers specimens in ID and names them in IMAGE."""
    values = {key: value for _, key, value in block if value}
    image = PureWindowsPath(values.get("IMAGE", "")).stem
    known = values.get("ID", "")
    return image if image and (not known or re.fullmatch(r"\d+", known)) else known


def _specimen(path: Path, block: Sequence[Line]) -> Landmarks:
    rows, scale, expected = Rows(path), 1.0, 0
    for number, key, value in block:
        if not key:
            _add(rows, number, value, expected)
        elif key in (*LANDMARKS, "POINTS", "POINTS3"):
            _full(path, number, rows, expected)
            expected += whole(path, number, value)
        elif key == "SCALE":
            word = plain_number(value)
            if not is_number(word) or not 0 < float(word) < float("inf"):
                raise BadLandmarkFile(f"{path}, line {number}: the scale {value[:40]!r} is no positive number")
            scale = float(word)
    _full(path, block[-1][0], rows, expected)
    landmarks = rows.landmarks()
    return landmarks if scale == 1 else replace(landmarks, at=landmarks.at * scale)


def _add(rows: Rows, number: int, value: str, expected: int) -> None:
    words = value.split()
    if len(rows.names) == expected:
        raise BadLandmarkFile(f"{rows.path}, line {number}: {value[:40]!r} is one more than LM3= declares")
    if len(words) == 2:
        raise BadLandmarkFile(
            f"{rows.path}, line {number}: 2 coordinates, of an image; landmarks in space have 3 (LM3=)"
        )
    rows.add(f"line {number}", None, position(rows.path, number, words))


def _full(path: Path, number: int, rows: Rows, expected: int) -> None:
    if len(rows.names) != expected:
        raise BadLandmarkFile(f"{path}, line {number}: it declares {expected} landmarks and holds {len(rows.names)}")
