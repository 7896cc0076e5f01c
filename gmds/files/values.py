"""Values in a file, a row for every vertex of a mesh."""

from __future__ import annotations

import csv
import errno
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats
from geodesics.errors import FormatError
from geodesics.io.opening import recoded
from gmds.files.npz import read_npy
from gmds.files.table import delimiter, plain_number, unguarded

KINDS = "biufcU"  # truth values, numbers, words


class BadValuesFile(FormatError):
    """A file of values that cannot be read, or that has another number of rows than the mesh has vertices."""

    code = "E307"


def read_values(path: Path, count: int, *, labels: bool = False) -> NDArray[Any]:
    """Values (count,) or (count, k) from a .npy or a text file, .csv with commas (or semicolons) or .txt with blanks.

    In text one line more than there are vertices is a header, as are words above numbers; a first column that it calls
    `vertex` counts from 0.
    Text holds numbers, float64; with `labels` whole numbers, int64, or else words. Raises `BadValuesFile`.
    """
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "it is not a regular file", str(path))
    values = _array(path) if path.suffix.lower() == ".npy" else _from_text(path, count, labels)
    if values.ndim == 0 or len(values) != count:
        rows = "a single value" if values.ndim == 0 else f"{len(values)} rows"
        raise BadValuesFile(f"{path} has {rows}; the target has {count} vertices and needs one row for each")
    return values


def _array(path: Path) -> NDArray[Any]:
    try:
        values = read_npy(path)
    except ValueError as error:
        raise BadValuesFile(f"{path} is not a readable .npy array ({error})") from error
    if values.dtype.kind not in KINDS:
        raise BadValuesFile(f"{path} holds {values.dtype}; write numbers or words")
    return values


def _from_text(path: Path, count: int, labels: bool) -> NDArray[Any]:
    rows = _rows(path)
    numbered = bool(rows) and _is_numbered(rows[0][1])
    headed = numbered or len(rows) == count + 1 or (not labels and len(rows) > 1 and _is_header(*rows[:2]))
    rows = rows[1:] if headed else rows
    if len(rows) != count:
        found = f"{len(rows)} rows{' below its header' if headed else ''}"
        raise BadValuesFile(f"{path} has {found}; the target has {count} vertices and needs one row for each")
    rows = _without_numbers(path, rows) if numbered else rows
    width = len(rows[0][1])
    for number, words in rows:
        if len(words) != width:
            raise BadValuesFile(f"{path}, line {number}: {len(words)} entries where the first row has {width}")
    values = _labels(path, rows) if labels else _numbers(path, rows)
    return values[:, 0] if width == 1 else values


def _rows(path: Path) -> list[tuple[int, list[str]]]:
    """Line numbers, and the entries of lines that are not empty."""
    try:
        lines = recoded(path.read_bytes()).decode("utf-8-sig").splitlines()
        if path.suffix.lower() == ".csv":
            reader = csv.reader(lines, delimiter=delimiter(lines[0] if lines else ""))
            return [(reader.line_num, words) for words in reader if words]
        return [(number, line.split()) for number, line in enumerate(lines, start=1) if line.strip()]
    except (UnicodeDecodeError, csv.Error) as error:
        raise BadValuesFile(f"{path} is not UTF-8 text ({error})") from error


def _is_numbered(header: list[str]) -> bool:
    """Whether the first row says that vertices are numbered."""
    return header[0].strip().lower() == "vertex" and len(header) > 1


def _is_header(first: tuple[int, list[str]], second: tuple[int, list[str]]) -> bool:
    """Whether the first row holds words alone, and the second numbers alone."""
    return not any(map(_is_number, first[1])) and all(map(_is_number, second[1]))


def _is_number(word: str) -> bool:
    try:
        float(plain_number(word))
    except ValueError:
        return False
    return True


def _without_numbers(path: Path, rows: list[tuple[int, list[str]]]) -> list[tuple[int, list[str]]]:
    for expected, (number, words) in enumerate(rows):
        if words[0].strip() != str(expected):
            raise BadValuesFile(f"{path}, line {number}: vertex {words[0][:40]!r} where {expected} should be")
    return [(number, words[1:]) for number, words in rows]


def _numbers(path: Path, rows: list[tuple[int, list[str]]]) -> Floats:
    values = np.empty((len(rows), len(rows[0][1])))
    for i, (number, words) in enumerate(rows):
        for j, word in enumerate(words):
            try:
                values[i, j] = float(plain_number(word))
            except ValueError:
                hint = "give --labels if values are names"
                raise BadValuesFile(f"{path}, line {number}: {word[:40]!r} is not a number; {hint}") from None
    return values


def _labels(path: Path, rows: list[tuple[int, list[str]]]) -> NDArray[Any]:
    as_given = unguarded if path.suffix.lower() == ".csv" else str
    words = [[as_given(word) for word in words] for _, words in rows]
    try:
        return np.array([[int(word) for word in row] for row in words], dtype=np.int64)
    except (ValueError, OverflowError):
        return np.array(words, dtype=np.str_)
