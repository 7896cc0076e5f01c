"""The text of a landmark file, and the numbers in it; every error names the file and the line."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from gmds.files.table import NUMBER, plain_number
from gmds.files.text import read_text
from gmds.landmarks.files.named_points import BadLandmarkFile, Landmarks, PointList, Status

LARGEST = 50_000_000  # bytes of a landmark file: a bound on memory, half a million landmarks
NOWHERE = ("", "na", "n/a", "nan", "null", "none", "-")  # words of R, spreadsheets and Python for what is missing
WHOLE = r"[+-]?\d{1,18}"  # 18 digits always fit into int64


def landmark_text(path: Path) -> str:
    """The content of a UTF-8 file of at most 50 MB. Raises `BadLandmarkFile`, or `OSError` for what is no file."""
    try:
        return read_text(path, BadLandmarkFile, LARGEST)
    except UnicodeDecodeError as error:
        raise BadLandmarkFile(f"{path} is not UTF-8 text ({error}); save it as UTF-8") from error


def is_number(word: str) -> bool:
    """Whether a word is a plain decimal number."""
    return NUMBER.fullmatch(word.strip()) is not None


def is_no_place(word: str) -> bool:
    """Whether a word stands for a number that is missing."""
    return word.strip().lower() in NOWHERE


def position(path: Path, line: int, words: Sequence[str]) -> list[float] | None:
    """Three coordinates from three words, with decimal points or commas; None when all three say that it is missing."""
    words = [word.strip() for word in words]
    if len(words) != 3:
        raise BadLandmarkFile(f"{path}, line {line}: {len(words)} coordinates; a landmark in space has 3")
    if all(map(is_no_place, words)):
        return None
    if not any("." in word for word in words):  # beside a decimal point a comma may part thousands
        words = [plain_number(word) for word in words]
    wrong = [word for word in words if not is_number(word)]
    if wrong:
        raise BadLandmarkFile(f"{path}, line {line}: {wrong[0][:40]!r} is not a number")
    values = [float(word) for word in words]
    if not all(math.isfinite(value) for value in values):
        raise BadLandmarkFile(f"{path}, line {line}: a coordinate is too large for float64")
    return values


def whole(path: Path, line: int, word: str, least: int = 0) -> int:
    """A whole number, at least `least`."""
    word = word.strip()
    if not re.fullmatch(WHOLE, word, re.ASCII):
        raise BadLandmarkFile(f"{path}, line {line}: {word[:40]!r} is not a whole number")
    if int(word) < least:
        raise BadLandmarkFile(f"{path}, line {line}: {int(word)} is below {least}")
    return int(word)


class Rows:
    """Landmarks as they are read, one after the other, so that errors can name the file."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.names: list[str] = []
        self.at: list[list[float] | int | None] = []
        self.status: list[Status] = []
        self.named = True
        self.selected: list[bool] = []
        self.lists: list[PointList] = []

    def add(
        self,
        where: str,
        name: str | None,
        at: list[float] | int | None,
        status: Status = "missing",
        *,
        selected: bool = True,
    ) -> None:
        """One landmark: its line or place, its name if it has one, and where it is; None: nowhere, of this status."""
        self.selected.append(selected)
        if not (name or "").strip():
            name, self.named = None, False
        self.names.append(" ".join(name.split()) if name is not None else str(len(self.names) + 1))
        self.at.append(at)
        self.status.append(status if at is None else "defined")

    def landmarks(self) -> Landmarks:
        """All of them. Raises `BadLandmarkFile` when there are none, or none has a place."""
        if not self.names:
            raise BadLandmarkFile(f"{self.path} holds no landmarks")
        if "defined" not in self.status:
            raise BadLandmarkFile(f"{self.path}: none of its {len(self.names)} landmarks has a place")
        known = next(at for at in self.at if at is not None)
        nowhere: list[float] | int = -1 if isinstance(known, int) else [math.nan] * len(known)
        at = np.array([nowhere if one is None else one for one in self.at])
        said = tuple(self.status), tuple(self.selected), tuple(self.lists)
        return Landmarks(tuple(self.names), at, self.named, *said)
