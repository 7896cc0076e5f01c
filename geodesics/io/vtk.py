"""Legacy files of VTK, versions 1.0 to 5.1: PolyData, and the polygons of an unstructured grid; text or binary."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats, Integers
from geodesics.errors import BadShape, FormatError, UnknownFormat
from geodesics.io.cells import Cells, from_counts, from_offsets, joined, no_cells, of_types, surface
from geodesics.io.contents import Contents
from geodesics.io.cursor import Cursor

_SECTIONS = ("POINTS", "VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS", "CELLS", "CELL_TYPES", "FIELD", "METADATA")
_END = ("POINT_DATA", "CELL_DATA")  # what lies on the surface; nothing that is needed comes behind it


@dataclass
class _Found:
    """What has been read so far."""

    vertices: Floats | None
    polygons: list[Cells]
    strips: list[Cells]
    cells: Cells | None = None
    types: Integers | None = None


def read_vtk(data: bytes, path: Path) -> Contents:
    """A legacy VTK file; values on vertices and faces are passed over."""
    cursor = Cursor(data, path)
    version = cursor.line().split()[-1]
    cursor.line()  # a title, which may be blank
    encoding = cursor.line().strip().upper()
    if encoding not in ("ASCII", "BINARY"):
        raise FormatError(f"{path}, line 3: ASCII or BINARY expected, {encoding[:40]!r} found")
    cursor.binary = encoding == "BINARY"
    words = cursor.words()
    kind = words[-1].upper() if words and words[0].upper() == "DATASET" else "no DATASET"
    if kind not in ("POLYDATA", "UNSTRUCTURED_GRID"):
        raise UnknownFormat(f"{path}: VTK files of {kind[:40]} hold no surface; save it as PolyData")
    found = _Found(None, [], [])
    offsets = version >= "5" and version[:1].isdigit()
    while (words := cursor.words()) and words[0].upper() not in _END:
        _read_section(cursor, [words[0].upper(), *words[1:]], offsets, found)
    if found.vertices is None:
        raise FormatError(f"{path}: the file has no POINTS")
    polygons, strips = joined(found.polygons), joined(found.strips)
    if found.cells is not None:
        types = found.types if found.types is not None else np.empty(0, dtype=np.int64)
        polygons, strips = of_types(found.cells, types, path)
    return surface(found.vertices, polygons, strips, path, [])


def _read_section(cursor: Cursor, words: list[str], offsets: bool, found: _Found) -> None:
    keyword = words[0]
    if keyword not in _SECTIONS:
        raise cursor.unexpected(words[0], "a section of a VTK file")
    if keyword == "METADATA":
        cursor.skip_to_blank()
    elif keyword == "FIELD":
        _skip_field(cursor, words)
    elif keyword == "POINTS":
        n, kind = cursor.count(words, 1), words[2].lower() if len(words) > 2 else "float"
        found.vertices = cursor.array(3 * n, kind).astype(np.float64).reshape(-1, 3)
    elif keyword == "CELL_TYPES":
        found.types = _whole(cursor.array(cursor.count(words, 1), "int"), cursor)
    else:
        cells = _cells(cursor, words, offsets)
        if keyword == "CELLS":
            found.cells = cells
        elif keyword in ("POLYGONS", "TRIANGLE_STRIPS"):
            (found.polygons if keyword == "POLYGONS" else found.strips).append(cells)


def _cells(cursor: Cursor, words: list[str], offsets: bool) -> Cells:
    """Cells as versions up to 4.2 have them, each with its size in front, or as 5.0 and 5.1 do, with offsets."""
    first, second = cursor.count(words, 1), cursor.count(words, 2)
    if not offsets or cursor.peek().upper() != "OFFSETS":
        return from_counts(_whole(cursor.array(second, "int"), cursor), first, cursor.path) if first else no_cells()
    arrays = []
    for size in (first, second):
        titles = cursor.words()
        if len(titles) < 2:
            raise cursor.unexpected(" ".join(titles), "OFFSETS or CONNECTIVITY and a type")
        arrays.append(_whole(cursor.array(size, titles[1].lower()), cursor))
    return from_offsets(arrays[0], arrays[1], cursor.path) if first else no_cells()


def _skip_field(cursor: Cursor, words: list[str]) -> None:
    for _ in range(cursor.count(words, 2)):
        title = cursor.words()
        if title and title[0].upper() == "METADATA":
            cursor.skip_to_blank()
            title = cursor.words()
        if len(title) < 4:
            raise cursor.unexpected(" ".join(title), "name, components, rows and type of an array")
        n = cursor.count(title, 1) * cursor.count(title, 2)
        cursor.skip(n, title[3].lower())


def _whole(values: NDArray[np.generic], cursor: Cursor) -> Integers:
    if values.dtype.kind == "f":
        table = values.astype(np.float64)
        if not np.array_equal(table, np.floor(table)):
            raise BadShape(f"{cursor.path}: vertices of cells must be whole numbers")
        return np.clip(table, -1, 2**62).astype(np.int64)  # what no vertex can be stays so
    return values.astype(np.int64)
