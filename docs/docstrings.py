"""Docstrings as sphinx needs them: plain text with `names`, formulas, tables, and sections as those of numpy.

Marks of reStructuredText that a reader of the source would not take for marks, such as the bars of |K| or the star of a
product, are escaped. What is written for sphinx stays: roles, directives with what is indented below them, and lines
of a Python prompt, with what they print. Sections are left to sphinx.ext.napoleon, which comes afterwards.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

MARKS = re.compile(r"(`[^`]*`)|([*|]|_(?!\w))")
TABLE = ("| ", "|--")


def plain(_app: Any, _what: str, _name: str, _thing: Any, _options: Any, lines: list[str]) -> None:
    """The listener of autodoc's event: changes `lines` in place."""
    made: list[str] = []
    for kind, group in blocks(lines):
        made += {"table": table, "text": escaped, "markup": list}[kind](group)
    lines[:] = made


def blocks(lines: Iterable[str]) -> Iterator[tuple[str, list[str]]]:
    """Lines in groups of one kind: a "table", "markup" meant for sphinx, or "text"."""
    kind, group, column = "text", [], -1  # a directive lasts while lines are indented deeper than its column
    prompt = False
    for line in lines:
        before, stripped = kind, line.strip()
        indent = len(line) - len(line.lstrip())
        if column >= 0 and (not stripped or indent > column):
            kind = "markup"
        else:
            column = indent if stripped.startswith(".. ") else -1
            prompt = stripped.startswith(">>> ") or (prompt and bool(stripped))  # and what is printed, to an empty line
            kind = "table" if line.startswith(TABLE) else "markup" if column >= 0 or prompt else "text"
        if group and kind != before:
            yield before, group
            group = []
        group.append(line)
    if group:
        yield kind, group


def escaped(lines: list[str]) -> list[str]:
    return [MARKS.sub(lambda found: found[1] or "\\" + found[2], line) for line in lines]


def table(lines: list[str]) -> list[str]:
    rows = [escaped([cell.strip() for cell in line.strip("| ").split("|")]) for line in lines if "|--" not in line]
    cells = [f"   {'  -' if column else '* -'} {cell}" for row in rows for column, cell in enumerate(row)]
    return [".. list-table::", "   :header-rows: 1", "", *cells, ""]
