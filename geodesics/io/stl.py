"""STL: triangles without shared vertices; corners at exactly equal positions are welded."""

from __future__ import annotations

import re
from io import BytesIO
from pathlib import Path

import numpy as np

from geodesics.arrays import Floats
from geodesics.errors import Note, TruncatedFile
from geodesics.io.opening import is_binary_stl
from geodesics.io.text import Contents, numbers, rows

_FACET = ["facet", "outer", "vertex", "vertex", "vertex", "endloop", "endfacet"]


def read_stl(data: bytes, path: Path) -> Contents:
    """A binary or ASCII STL file; vertices are numbered in order of first appearance, with a note (W211)."""
    if is_binary_stl(data):
        from trimesh.exchange.stl import load_stl_binary

        soup = np.array(load_stl_binary(BytesIO(data)).get("vertices", np.empty((0, 3))), dtype=np.float64)
    elif not re.match(rb"\s*solid\b", data, re.IGNORECASE) or b"\0" in data[:1024]:
        declared = int.from_bytes(data[80:84], "little")
        raise TruncatedFile(
            f"{path}: neither binary STL ({declared} triangles need {84 + 50 * declared} bytes, "
            f"the file has {len(data)}) nor ASCII STL"
        )
    else:
        soup = _read_ascii(data, path)
    return _weld(soup)


def _read_ascii(data: bytes, path: Path) -> Floats:
    """Corner positions (3 m, 3) of an ASCII STL file whose every facet is complete."""
    vertex_rows, state, keyword = [], 0, ""
    for row in rows(data, path, comment=None):
        keyword = row.words[0].lower()
        if state == 0 and keyword in ("solid", "endsolid"):
            continue
        if keyword != _FACET[state]:
            raise TruncatedFile(f"{path}, line {row.line}: {_FACET[state]!r} expected, {row.words[0][:40]!r} found")
        if keyword == "vertex":
            vertex_rows.append(row)
        state = (state + 1) % len(_FACET)
    if keyword != "endsolid":
        raise TruncatedFile(f"{path}: the file does not end in endsolid")
    return numbers(vertex_rows, 1, path)


def _weld(soup: Floats) -> Contents:
    """Equal positions become one vertex, numbered by first appearance."""
    _, first, inverse = np.unique(soup, axis=0, return_index=True, return_inverse=True)
    rank = np.empty(len(first), dtype=np.int64)
    order = np.argsort(first)
    rank[order] = np.arange(len(first))
    message = f"{len(soup)} corners at {len(first)} distinct positions were welded into that many vertices"
    return Contents(soup[first[order]], rank[inverse.reshape(-1, 3)], [Note("W211", "info", message)])
