"""Strict reading of numbers in text: every reader of a text format is built from these."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.errors import (
    BadCount,
    BadPolygon,
    BadToken,
    IndexOutOfRange,
    LineTooLong,
    Note,
    TruncatedFile,
)
from geodesics.io.opening import LONGEST_LINE

_DECIMAL = frozenset("0123456789+-.eE")


@dataclass(frozen=True, eq=False)
class Contents:
    """What a file holds: vertices (n, 3), triangles (m, 3) and the notes taken on the way."""

    vertices: Floats
    triangles: Integers
    notes: list[Note] = field(default_factory=list)


class Row(NamedTuple):
    """One line that says something: its number in the file (from 1) and its words."""

    line: int
    words: list[str]


def rows(data: bytes, path: Path, comment: str | None = "#", first_line: int = 1) -> Iterator[Row]:
    """The lines of `data` that are not blank once comments are cut off; any line ending, any encoding of comments."""
    text = data.removeprefix(b"\xef\xbb\xbf").decode("latin-1").replace("\r\n", "\n").replace("\r", "\n")
    for number, line in enumerate(text.split("\n"), first_line):
        if len(line) > LONGEST_LINE:
            raise LineTooLong(f"{path}, line {number}: longer than {LONGEST_LINE} bytes")
        words = (line.split(comment, 1)[0] if comment else line).split()
        if words:
            yield Row(number, words)


def numbers(table: Sequence[Row], first: int, path: Path, columns: int = 3) -> Floats:
    """Words first .. first + columns of every row, as float64; only plain decimals pass (`BadToken`, E207)."""
    for row in table:
        if len(row.words) < first + columns:
            raise TruncatedFile(f"{path}, line {row.line}: {columns} numbers expected, {len(row.words) - first} found")
    words = [row.words[first : first + columns] for row in table]
    if _DECIMAL.issuperset("".join(chain.from_iterable(words))):
        try:
            return np.array(words, dtype=np.float64).reshape(-1, columns)
        except ValueError:
            pass
    raise _first_bad_number(table, first, columns, path)


def _first_bad_number(table: Sequence[Row], first: int, columns: int, path: Path) -> BadToken:
    for row in table:
        for word in row.words[first : first + columns]:
            try:
                float(word if _DECIMAL.issuperset(word) else "no")
            except ValueError:
                hint = "; write decimals with a point, not a comma" if "," in word else ""
                return BadToken(f"{path}, line {row.line}: {word[:40]!r} is not a finite decimal number{hint}")
    raise AssertionError("called without a bad number")


def whole(word: str, place: str) -> int:
    """A whole number, possibly negative; `BadToken` naming `place` for anything else."""
    digits = word.removeprefix("-")
    if not (digits.isascii() and digits.isdecimal()):
        raise BadToken(f"{place}: {word[:40]!r} is not a whole number")
    size = int(digits) if len(digits) < 20 else 10**20
    return -size if word.startswith("-") else size


def count(word: str, bytes_each: int, data: bytes, place: str) -> int:
    """A declared count, refused (`BadCount`, E205) before anything is allocated when the file is too short for it."""
    try:
        value = whole(word, place)
    except BadToken as error:
        raise BadCount(f"{place}: the count {word[:40]!r} is not a whole number") from error
    if value < 0:
        raise BadCount(f"{place}: the count {word[:40]} is negative")
    if value * bytes_each > len(data):
        raise BadCount(f"{place}: {word[:40]} items are declared, more than {len(data)} bytes can hold")
    return value


def corners(row: Row, first: int, n_vertices: int, base: int, path: Path) -> list[int]:
    """A face line `degree i j k ...` whose degree is word `first`: its 0-based corners, all checked."""
    place = f"{path}, line {row.line}"
    degree = whole(row.words[first], place)
    if degree < 3:
        raise BadPolygon(f"{place}: a face of {degree} corners; a face has at least three")
    words = row.words[first + 1 : first + 1 + degree]
    if len(words) < degree:
        raise BadPolygon(f"{place}: a face of {row.words[first][:40]} corners, but the line holds {len(words)}")
    return [vertex_index(word, n_vertices, base, place) for word in words]


def vertex_index(word: str, n_vertices: int, base: int, place: str) -> int:
    """A 0-based vertex index from a `base`-based one; `IndexOutOfRange` when there is no such vertex."""
    index = whole(word, place) - base
    if not 0 <= index < n_vertices:
        raise IndexOutOfRange(
            f"{place}: index {word[:40]} refers outside the {n_vertices} vertices (counted from {base})"
        )
    return index


def fan(polygons: list[list[int]]) -> tuple[Integers, list[Note]]:
    """Polygons split into triangles about their first corner, in order, with a note (W210) when any was larger."""
    triangles = [(p[0], p[i], p[i + 1]) for p in polygons for i in range(1, len(p) - 1)]
    larger = [i for i, p in enumerate(polygons) if len(p) > 3]
    notes = []
    if larger:
        message = f"{len(larger)} of {len(polygons)} faces have more than three corners and were split into triangles"
        notes.append(Note("W210", "info", message, tuple(larger[:10])))
    return np.array(triangles, dtype=np.int64).reshape(-1, 3), notes
