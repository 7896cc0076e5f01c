"""Strict reading of numbers in text: every reader of a text format is built from these."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import numpy as np

from geodesics.arrays import Floats
from geodesics.errors import (
    BadCount,
    BadPolygon,
    BadToken,
    IndexOutOfRange,
    LineTooLong,
    TruncatedFile,
)
from geodesics.io.opening import LONGEST_LINE

_DECIMAL = frozenset("0123456789+-.eE")
_UNKNOWN = re.compile(r"[-+]?(nan(\(\w*\))?|inf(inity)?|1\.?#(ind|qnan|snan|inf)\w*)", re.IGNORECASE)


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
        words = (_uncommented(line, comment) if comment and comment in line else line).split()
        if words:
            yield Row(number, words)


def _uncommented(line: str, comment: str) -> str:
    """A line up to its comment, which begins with a mark that is not that of an unknown number, as in 1.#QNAN."""
    found = re.search(rf"(?<!1\.)(?<!1){comment}|{comment}(?!ind|qnan|snan|inf)", line, re.IGNORECASE)
    return line[: found.start()] if found else line


def numbers(table: Sequence[Row], first: int, path: Path, columns: int = 3, *, unknown: bool = False) -> Floats:
    """Words first .. first + columns of every row, as float64; only plain decimals pass (`BadToken`, E207).

    With `unknown`, the words by which programs write that there is no number, such as nan and -1.#IND, are NaN.
    """
    for row in table:
        if len(row.words) < first + columns:
            raise TruncatedFile(f"{path}, line {row.line}: {columns} numbers expected, {len(row.words) - first} found")
    if not columns:
        return np.empty((len(table), 0))
    words = [row.words[first : first + columns] for row in table]
    if _DECIMAL.issuperset("".join(chain.from_iterable(words))):
        try:
            return np.array(words, dtype=np.float64).reshape(-1, columns)
        except ValueError:
            pass
    values = [[_number(word, row, path, unknown) for word in row.words[first : first + columns]] for row in table]
    return np.array(values, dtype=np.float64).reshape(-1, columns)


def _number(word: str, row: Row, path: Path, unknown: bool) -> float:
    if unknown and _UNKNOWN.fullmatch(word):
        return float("nan")
    try:
        return float(word if _DECIMAL.issuperset(word) else "no")
    except ValueError:
        hint = "; write decimals with a point, not a comma" if "," in word else ""
        message = f"{path}, line {row.line}: {word[:40]!r} is not a finite decimal number{hint}"
    raise BadToken(message)


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
    if degree < 0:
        raise BadPolygon(f"{place}: a face of {degree} corners")
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
