"""CSV tables: the one way in which tables are written, safe to open in a spreadsheet.

A spreadsheet runs a cell that begins with = + - or @ as a formula. Such text gets an apostrophe in front, as OWASP
advises against CSV injection; `unguarded` takes it away again. Rows end with a line feed, and a row is a line.
"""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Iterable, Sequence
from itertools import chain
from pathlib import Path

from geodesics.io.atomic import atomic_write

FORMULA = re.compile(r"'*(\s*[=+\-@\uff1d\uff0b\uff0d\uff20]|\t)")  # the last four are the full-width forms
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def write_table(
    path: str | os.PathLike[str], head: Sequence[str], rows: Iterable[Sequence[object]], *, digits: int | None = None
) -> None:
    """Write a header and rows, atomically, in UTF-8; cells as in `table_text`."""
    text = table_text(chain([head], rows), digits=digits)
    with atomic_write(path) as stream:
        stream.write(text.encode("utf-8", "replace"))  # a file name need not be valid Unicode


def table_text(rows: Iterable[Sequence[object]], *, digits: int | None = None) -> str:
    """Rows as CSV, in which None is an empty cell and text that a spreadsheet would run as a formula is quoted.

    Floats have `digits` significant digits, or all that it takes to read the same number.
    """
    text = io.StringIO(newline="")
    csv.writer(text, lineterminator="\n").writerows(_cells(row, digits) for row in rows)
    return text.getvalue()


def read_table(path: Path) -> list[dict[str, str]]:
    """The rows of a table that `write_table` wrote, each cell under the title of its column."""
    with path.open(newline="", encoding="utf-8") as stream:
        head, *rows = filter(None, csv.reader(stream))
        titles = list(map(unguarded, head))
        return [dict(zip(titles, map(unguarded, row), strict=True)) for row in rows]


def delimiter(line: str) -> str:
    """What parts the cells of a line: a tab, else a semicolon unless there are more commas, which may be decimal."""
    bare = re.sub('"[^"]*"', "", line)
    return "\t" if "\t" in bare else ";" if bare.count(";") >= max(1, bare.count(",")) else ","


def plain_number(word: str) -> str:
    """The word, or with a decimal point where it has one decimal comma."""
    word = word.strip()
    return word.replace(",", ".") if word.count(",") == 1 and "." not in word else word


def unguarded(text: str) -> str:
    """A cell of one of our tables as it was before it was written."""
    return text[1:] if text.startswith("'") and FORMULA.match(text) else text


def _cells(row: Sequence[object], digits: int | None) -> list[object]:
    cells = [_guarded(value) if isinstance(value, str) else value for value in row]
    return cells if digits is None else [f"{x:.{digits}g}" if isinstance(x, float) else x for x in cells]


def _guarded(text: str) -> str:
    """Text on one line, with an apostrophe in front where it could be run as a formula or be taken for quoted."""
    line = " ".join(text.splitlines())
    return f"'{line}" if FORMULA.match(line) and not NUMBER.fullmatch(line) else line
