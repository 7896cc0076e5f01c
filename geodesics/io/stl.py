"""STL: triangles without shared vertices; corners at exactly equal positions are welded."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

import numpy as np

from geodesics.arrays import Floats
from geodesics.errors import EmptyMesh, TruncatedFile
from geodesics.io.contents import Contents
from geodesics.io.sniffing import is_binary_stl
from geodesics.io.text import Row, numbers, rows
from geodesics.notes import Note

_FACET = ["facet", "outer", "vertex", "vertex", "vertex", "endloop", "endfacet"]
_LENGTHS = {"facet": 5, "outer": 2, "vertex": 4, "endloop": 1, "endfacet": 1}  # words of each; the rest is the next
_IGNORED = ("solid", "endsolid", "color", "colour", "name")  # what may stand between facets


def read_stl(data: bytes, path: Path) -> Contents:
    """A binary or ASCII STL file; vertices are numbered in order of first appearance, with a note (W211)."""
    declared = int.from_bytes(data[80:84], "little")
    is_text = re.match(rb"\s*solid\b", data, re.IGNORECASE) is not None and b"\0" not in data[:1024]
    uncounted = declared == 0 and not is_text and len(data) > 84 and len(data) % 50 == 34  # who writes as it goes
    declared = (len(data) - 84) // 50 if uncounted else declared
    longer = len(data) - 84 - 50 * declared
    if is_binary_stl(data) or (not is_text and declared and longer >= 0):
        facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        soup = np.frombuffer(data, facet, declared, 84)["corners"].reshape(-1, 3)
        welded = _weld(soup.astype(np.float64), longer, path)
        if uncounted:
            welded.notes.append(Note("W220", "info", f"0 triangles are declared; the {declared} that follow were read"))
        return welded
    if not is_text:
        raise TruncatedFile(
            f"{path}: neither binary STL ({declared} triangles need {84 + 50 * declared} bytes, "
            f"the file has {len(data)}) nor ASCII STL"
        )
    soup, ended = _read_ascii(data, path)
    welded = _weld(soup, 0, path)
    if not ended:
        message = "the file does not end in endsolid: facets may be missing, if it was cut off"
        welded.notes.append(Note("W227", "warning", message))
    return welded


def _read_ascii(data: bytes, path: Path) -> tuple[Floats, bool]:
    """Corner positions (3 m, 3) of an ASCII STL file whose every facet is complete, and whether its end is there."""
    vertex_rows, state, keyword = [], 0, ""
    for row in chain.from_iterable(map(_statements, rows(data, path, comment=None))):
        keyword = row.words[0].lower()
        if keyword == "end" and len(row.words) > 1:  # some write two words
            keyword += row.words[1].lower()
        if state == 0 and keyword in _IGNORED:
            continue
        if keyword != _FACET[state]:
            raise TruncatedFile(f"{path}, line {row.line}: {_FACET[state]!r} expected, {row.words[0][:40]!r} found")
        if keyword == "vertex":
            vertex_rows.append(row)
        state = (state + 1) % len(_FACET)
    if state:
        raise TruncatedFile(f"{path}: the file ends within a facet, where {_FACET[state]!r} is expected")
    return numbers(vertex_rows, 1, path, unknown=True), keyword == "endsolid"


def _statements(row: Row) -> Iterator[Row]:
    """What a line says, which may be more than one thing."""
    words = row.words
    while len(words) > (length := _length(words)) and words[length].lower() in (*_LENGTHS, "end", "endsolid"):
        yield Row(row.line, words[:length])
        words = words[length:]
    yield Row(row.line, words)


def _length(words: list[str]) -> int:
    """How many words the first thing that is said has."""
    first = words[0].lower()
    if first == "solid":  # and any name
        return next((i for i, word in enumerate(words) if word.lower() == "facet" and i), len(words))
    if first == "end":
        return 2 if len(words) > 1 and words[1].lower() in ("loop", "facet") else len(words)
    return _LENGTHS.get(first, len(words))


def _weld(soup: Floats, longer: int, path: Path) -> Contents:
    """Equal positions become one vertex, numbered by first appearance."""
    if len(soup) == 0:
        raise EmptyMesh(f"{path}: no vertices, as there is no facet")
    _, first, inverse = np.unique(soup, axis=0, return_index=True, return_inverse=True)
    rank = np.empty(len(first), dtype=np.int64)
    order = np.argsort(first)
    rank[order] = np.arange(len(first))
    message = f"{len(soup)} corners at {len(first)} distinct positions were welded into that many vertices"
    notes = [Note("W211", "info", message)]
    if longer > 0:
        notes.append(Note("W220", "info", f"{longer} bytes behind the last triangle were passed over"))
    return Contents(soup[first[order]], rank[inverse.reshape(-1, 3)], notes)
