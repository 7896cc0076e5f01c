"""Landmarks in a text file: a pair of corresponding points a line."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gmds.landmark_files import BadLandmarkFile
from gmds.landmark_files.reading import NUMBER, WHOLE, read_text


def read_landmarks(path: Path) -> NDArray[np.int64] | tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Corresponding points from a text file, in a form that `match` takes.

    Lines of two whole numbers give vertex pairs (k, 2), 0-based; lines of six give positions (k, 3) on both.
    Blanks, commas or semicolons separate; `#` starts a comment. Raises `BadLandmarkFile` naming the line.
    """
    text = read_text(path)
    rows = [(number, _words(line)) for number, line in enumerate(text.splitlines(), start=1)]
    rows = [(number, words) for number, words in rows if words]
    if not rows:
        raise BadLandmarkFile(f"{path} holds no landmarks; write two vertex numbers or six coordinates a line")
    width = len(rows[0][1])
    if width not in (2, 6):
        raise BadLandmarkFile(
            f"{path}, line {rows[0][0]}: {width} entries; write two vertex numbers or six coordinates"
        )
    values = [_numbers(path, number, words, width) for number, words in rows]
    if width == 2:
        return np.array(values, dtype=np.int64)
    table = np.array(values, dtype=np.float64)
    return table[:, :3], table[:, 3:]


def _words(line: str) -> list[str]:
    return [word for word in re.split(r"[\s,;]+", line.split("#", 1)[0]) if word]


def _numbers(path: Path, number: int, words: list[str], width: int) -> list[Any]:
    if len(words) != width:
        raise BadLandmarkFile(f"{path}, line {number}: {len(words)} entries where the first line has {width}")
    pattern = WHOLE if width == 2 else NUMBER
    wrong = [word for word in words if not re.fullmatch(pattern, word, re.ASCII)]
    if wrong:
        kind = "a whole number" if width == 2 else "a number"
        raise BadLandmarkFile(f"{path}, line {number}: {wrong[0][:40]!r} is not {kind}")
    values = [int(word) if width == 2 else float(word) for word in words]
    if not np.isfinite(values).all():
        raise BadLandmarkFile(f"{path}, line {number}: a coordinate is too large for float64")
    return values
