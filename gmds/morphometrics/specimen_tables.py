"""Tables about specimens: groups and covariates read, coordinates of points written as other programs read them."""

from __future__ import annotations

import csv
import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Bools, Floats
from geodesics.io import atomic_write
from geodesics.io.opening import recoded
from gmds.errors import BadGroups
from gmds.files.folders import PACKED, SUFFIXES, plain_name
from gmds.files.table import delimiter, plain_number, unguarded, write_table
from gmds.suggestions import did_you_mean

NAMES = ("name", "specimen", "id", "file")  # titles of the column that says which specimen a row is about
MISSING = "NA"  # as R reads it
UNKNOWN = frozenset(("", "na", "n/a", "nan", "null", "none", "#n/a", "?", "-"))  # a convention of tables


def read_column(path: Path, column: str, names: Sequence[str]) -> NDArray[np.generic]:
    """What a table says of each specimen (k,) in one column: float64 where all are numbers, else words.

    The table has titles; specimens are in a column `name`, `specimen`, `id` or `file`, or else the first, called as
    their files are, with or without the ending, or as the atlas has them. Words for what is unknown (NA, NaN, ...) say
    nothing. Raises `BadGroups` (E235) naming a column or specimen that is not there, or there twice, `OSError`.
    """
    rows = _rows(path)
    titles = [unguarded(one).strip() for one in rows[0]]
    if column not in titles:
        raise BadGroups(f"{path} has no column {column!r}{did_you_mean(column, titles)}")
    if titles.count(column) > 1:
        raise BadGroups(f"{path} has {titles.count(column)} columns called {column!r}; leave one")
    key = next((i for i, title in enumerate(titles) if title.lower() in NAMES), 0)
    at = titles.index(column)
    said: dict[str, str] = {}
    for number, row in enumerate(rows[1:], start=2):
        if len(row) <= max(key, at):
            raise BadGroups(f"{path}, row {number}: {len(row)} cells where there are {len(titles)} titles")
        name, word = unguarded(row[key]).strip(), unguarded(row[at]).strip()
        if said.setdefault(name, word) != word:
            raise BadGroups(f"{path}, row {number}: {name} is {word} here and {said[name]} before; leave one")
    words = [_said_of(name, said) for name in names]
    absent = [name for name, word in zip(names, words, strict=True) if word.casefold() in UNKNOWN]
    if absent:
        others = f"; its rows are of {_first(said)}" if len(absent) == len(names) and said else ""
        one_of = f"one of {len(absent)} of {len(names)} specimens without a word"
        raise BadGroups(f"{path} says nothing of {absent[0]} under {column} ({one_of}){others}")
    numbers = [_number(word) for word in words]
    if None in numbers:
        if numbers.count(None) < len(numbers) and 2 * len(set(words)) > len(words):  # hardly groups: a slip in one cell
            name, word = next((n, w) for n, w, x in zip(names, words, numbers, strict=True) if x is None)
            raise BadGroups(f"{path}: {column} of {name} is {word!r}, no number, and others are numbers")
        return np.array(words, dtype=np.str_)
    found = np.array(numbers, dtype=np.float64)
    for name, number in zip(names, found, strict=True):
        if not np.isfinite(number):
            raise BadGroups(f"{path}: {column} of {name} is {number}, which is no number to compare with")
    return found


def _number(word: str) -> float | None:
    """A word as a number; None where it is none."""
    try:
        return float(plain_number(word))
    except ValueError:
        return None


def _first(said: Mapping[str, str]) -> str:
    """The first three names of a table."""
    return ", ".join([*itertools.islice(said, 3), *(["..."] if len(said) > 3 else [])])


def _rows(path: Path) -> list[list[str]]:
    """The rows of a table that are not empty, the first its titles."""
    try:
        text = recoded(path.read_bytes()).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise BadGroups(f"{path} is not UTF-8 text ({error})") from error
    lines = text.splitlines()
    try:
        rows = [row for row in csv.reader(lines, delimiter=delimiter(lines[0] if lines else "")) if any(row)]
    except csv.Error as error:
        raise BadGroups(f"{path} is no table ({error})") from error
    if len(rows) < 2:
        raise BadGroups(f"{path} has no rows below its titles")
    return rows


def _said_of(name: str, said: Mapping[str, str]) -> str:
    """What rows say of a specimen: of its name, else of the one file that goes by it; nothing where that is unsure."""
    if name in said:
        return said[name]
    found = {word for file, word in said.items() if name in _called(file)}
    return found.pop() if len(found) == 1 else ""


def _called(file: str) -> set[str]:
    """The names that a specimen in a file may have in an atlas, which has no spaces in names."""
    path = Path(file)
    packed = path.with_suffix("") if path.suffix.lower() == PACKED else path
    stem = packed.stem if packed.suffix.lower() in SUFFIXES else packed.name
    return {stem, plain_name(stem), plain_name(path.name)}


def write_points(path: Path, names: Sequence[str], points: Sequence[str], places: Floats, valid: Bools) -> None:
    """Points (k, p, 3) of k specimens, in the form that the ending says; missing ones are NA.

    .csv: a row a point (specimen, name, x, y, z). .wide.csv: a row a specimen (name, then P1.x, P1.y, P1.z, ...), as
    geomorph's `arrayspecs`, Morpho and ktch take it. .tps: a block a specimen, as geomorph's `readland.tps` reads it.
    """
    cells = [
        [list(map(float, at)) if there else [MISSING] * 3 for at, there in zip(row, mask, strict=True)]
        for row, mask in zip(places, valid, strict=True)
    ]
    if path.suffix.lower() == ".tps":
        blocks = []
        for name, row in zip(names, cells, strict=True):
            lines = [" ".join(map(str, at)) for at in row]
            blocks.append("\n".join([f"LM3={len(points)}", *lines, f"ID={name}"]))
        with atomic_write(path) as stream:
            stream.write(("\n".join(blocks) + "\n").encode("utf-8", "replace"))
    elif path.name.lower().endswith(".wide.csv"):
        titles = [f"{point}.{axis}" for point in points for axis in "xyz"]
        write_table(
            path, ["name", *titles], ([name, *itertools.chain(*row)] for name, row in zip(names, cells, strict=True))
        )
    else:
        rows = (
            [name, point, *at]
            for name, row in zip(names, cells, strict=True)
            for point, at in zip(points, row, strict=True)
        )
        write_table(path, ["specimen", "name", "x", "y", "z"], rows)
