"""The text of a landmark file, and the numbers in it; every error names the file and the line."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path

from gmds.files.table import NUMBER
from gmds.files.text import read_text
from gmds.landmarks.files.named_points import BadLandmarkFile, Landmarks

LARGEST = 50_000_000  # bytes of a landmark file: a bound on memory, half a million landmarks
WHOLE = r"[+-]?\d{1,18}"  # 18 digits always fit into int64


def landmark_text(path: Path) -> str:
    """The content of a UTF-8 file of at most 50 MB. Raises `BadLandmarkFile`, or `OSError` for what is no file."""
    try:
        return read_text(path, BadLandmarkFile, LARGEST)
    except UnicodeDecodeError as error:
        raise BadLandmarkFile(f"{path} is not UTF-8 text ({error})") from error


def is_number(word: str) -> bool:
    """Whether a word is a plain decimal number."""
    return NUMBER.fullmatch(word.strip()) is not None


def position(path: Path, line: int, words: Sequence[str]) -> list[float]:
    """Three coordinates from three words."""
    words = [word.strip() for word in words]
    if len(words) != 3:
        raise BadLandmarkFile(f"{path}, line {line}: {len(words)} coordinates; a landmark in space has 3")
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
    """Landmarks as they are read, one after the other, so that errors can name the line."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.names: list[str] = []
        self.at: list[list[float] | int] = []
        self.missing: list[str] = []
        self.named = True
        self.line_of: dict[str, str] = {}

    def add(self, where: str, name: str | None, at: list[float] | int | None) -> None:
        """One landmark: its line or place, its name if it has one, and where it is (None: nowhere)."""
        if not (name or "").strip():
            name, self.named = None, False
        called = " ".join(name.split()) if name is not None else str(len(self.names) + len(self.missing) + 1)
        if called in self.line_of:
            raise BadLandmarkFile(
                f"{self.path}, {where}: {called!r} is also the name of the landmark at {self.line_of[called]}"
            )
        self.line_of[called] = where
        if at is None:
            self.missing.append(called)
            return
        self.names.append(called)
        self.at.append(at)

    def landmarks(self) -> Landmarks:
        """All of them. Raises `BadLandmarkFile` when there are none."""
        if not self.names:
            raise BadLandmarkFile(f"{self.path} holds no landmarks")
        if self.missing and not self.named:
            raise BadLandmarkFile(
                f"{self.path}: landmark {self.missing[0]} has no place, and without names the order cannot tell"
            )
        return Landmarks(tuple(self.names), self.at, self.named, tuple(self.missing))  # type: ignore[arg-type]
