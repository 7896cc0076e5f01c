"""Landmarks in a text file, a pair of corresponding points a line, or those that a map was made with."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from gmds.landmarks.files import BadLandmarkFile
from gmds.landmarks.files.reading import WHOLE, is_number, landmark_text
from gmds.landmarks.soft import SoftLandmarks

WIDTHS = (2, 6, 8)  # entries of both points
ONE_SURFACE = "landmarks of one surface alone need a second file, for the other surface: --landmarks A --landmarks B"
FORMS = "two vertex numbers, six coordinates, or a face and three weights twice, and perhaps a tolerance"


def read_landmarks(path: Path) -> Any:
    """Corresponding points from a file, in a form that `match` takes.

    Lines of two whole numbers give vertex pairs (k, 2), 0-based; lines of six give positions (k, 3) on both, lines of
    eight a face and barycentric weights (k, 4) on both; one more entry is the tolerance of a soft landmark. Blanks,
    commas or semicolons separate; `#` starts a comment. A map (.npz) gives those it was made with. Raises
    `BadLandmarkFile` naming the line, `FormatError` for a damaged map.
    """
    if path.suffix.lower() == ".npz":
        return _of_map(path)
    text = landmark_text(path)
    rows = [(number, _words(line)) for number, line in enumerate(text.splitlines(), start=1)]
    rows = [(number, words) for number, words in rows if words]
    if not rows:
        raise BadLandmarkFile(f"{path} holds no landmarks; write {FORMS} a line")
    first, entries = rows[0][0], len(rows[0][1])
    soft = entries % 2
    for word in rows[0][1]:
        if not is_number(word) and any(map(str.isalpha, word)):  # a header, or a name
            raise BadLandmarkFile(f"{path}, line {first}: {word[:40]!r} is not a number; write {FORMS}; {ONE_SURFACE}")
    if entries - soft not in WIDTHS:
        raise BadLandmarkFile(f"{path}, line {first}: {entries} entries; write {FORMS}; {ONE_SURFACE}")
    table = np.array([_numbers(path, number, words, entries) for number, words in rows], dtype=np.float64)
    halves = np.split(table[:, : entries - soft], 2, axis=1)
    pairs = table[:, :2].astype(np.int64) if entries - soft == 2 else tuple(halves)
    return SoftLandmarks(pairs, table[:, -1]) if soft else pairs


def _of_map(path: Path) -> Any:
    from gmds.maps.npz_format import read_meta

    made = read_meta(path).get("parameters", {}).get("landmarks")
    if made is None:
        raise BadLandmarkFile(f"{path} is a map that was made without landmarks")
    try:
        sides = [np.column_stack([made[side]["face"], made[side]["barycentric"]]) for side in ("source", "target")]
        return SoftLandmarks((sides[0], sides[1]), made["tolerance"])
    except (KeyError, TypeError, ValueError) as error:
        raise BadLandmarkFile(f"{path}: the landmarks it was made with cannot be read ({error})") from error


def _words(line: str) -> list[str]:
    return [word for word in re.split(r"[\s,;]+", line.split("#", 1)[0]) if word]


def _numbers(path: Path, number: int, words: list[str], width: int) -> list[float]:
    if len(words) != width:
        raise BadLandmarkFile(f"{path}, line {number}: {len(words)} entries where the first line has {width}")
    for i, word in enumerate(words):
        whole = (width in (2, 3) and i < 2) or (width in (8, 9) and i in (0, 4))
        if not (re.fullmatch(WHOLE, word, re.ASCII) if whole else is_number(word)):
            kind = "a whole number" if whole else "a number"
            raise BadLandmarkFile(f"{path}, line {number}: {word[:40]!r} is not {kind}")
    values = [float(word) for word in words]
    if not np.isfinite(values).all():
        raise BadLandmarkFile(f"{path}, line {number}: a coordinate is too large for float64")
    return values
