"""PLY: a header naming elements and their properties, then the elements as text or binary."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geodesics.errors import BadPolygon, FormatError, IndexOutOfRange, TruncatedFile
from geodesics.io.cells import Cells, joined, no_cells, surface
from geodesics.io.contents import Contents
from geodesics.io.ply_columns import BinaryColumns, TextColumns, read_binary, read_text
from geodesics.io.ply_header import Element, Header, read_header
from geodesics.io.text import Row, rows
from geodesics.io.truncation import refuse_cut_face
from geodesics.notes import Note

Columns = BinaryColumns | TextColumns
_CORNERS = ("vertex_indices", "vertex_index")


def read_ply(data: bytes, path: Path) -> Contents:
    """A PLY file with elements vertex (x, y, z) and face or tristrips (vertex_indices); others are passed over."""
    header = read_header(data, path)
    vertex, face = header.elements.get("vertex"), header.elements.get("face")
    if vertex is None:
        raise FormatError(f"{path}: the header declares no vertices")
    axes = [vertex.find(axis) for axis in "xyz"]
    if min(axes) < 0 or any(vertex.properties[axis].size for axis in axes):
        raise FormatError(f"{path}: element vertex lacks one of the properties x, y, z")
    if face is not None and face.length and not _has_corners(face):
        raise FormatError(f"{path}: element face has no property vertex_indices")
    columns, notes = read_columns(data, header, path)
    vertices = columns["vertex"].numbers(axes) if vertex.length else np.empty((0, 3))
    polygons = _polygons(columns.get("face"), len(vertices))
    strips = [columns[name] for name in ("tristrips", "tristrip") if name in columns]
    ribbons = joined([_strips(each) for each in strips if _has_corners(each.element)])
    if header.encoding == "ascii" and face is not None and face is list(header.elements.values())[-1]:
        sizes, corners = polygons
        if face.properties and face.properties[-1].name in _CORNERS:
            listed = [part.tolist() for part in np.split(corners, np.cumsum(sizes)[:-1])] if len(sizes) else []
            refuse_cut_face(data, listed, len(vertices), 0, path)
    return surface(vertices, polygons, ribbons, path, notes)


def read_columns(data: bytes, header: Header, path: Path) -> tuple[dict[str, Columns], list[Note]]:
    """The columns of every element, and a note (W220) when there is more in the file."""
    columns: dict[str, Columns] = {}
    if header.encoding == "ascii":
        table = list(rows(data[header.body :], path, comment=None, first_line=header.n_lines + 1))
        try:
            columns, behind = _text_columns(table, header, path)
        except (BadPolygon, TruncatedFile):
            flowing = _rearranged(table, header)
            if flowing is None:
                raise
            columns, behind = _text_columns(flowing, header, path)
        what = f"{behind} lines"
    else:
        at, order = header.body, "<" if header.encoding == "binary_little_endian" else ">"
        for name, element in header.elements.items():
            columns[name], at = read_binary(element, data, at, order, path)
        behind = len(data) - at
        what = f"{behind} bytes"
    return columns, [Note("W220", "info", f"{what} behind the declared elements were passed over")] if behind else []


def _text_columns(table: list[Row], header: Header, path: Path) -> tuple[dict[str, Columns], int]:
    """The columns of elements in text, a line each, and how many lines are left."""
    lines = iter(table)
    columns: dict[str, Columns] = {name: read_text(each, lines, path) for name, each in header.elements.items()}
    return columns, sum(1 for _ in lines)


def _rearranged(table: list[Row], header: Header) -> list[Row] | None:
    """A row for each of what the header declares, of a file whose lines end elsewhere; None where words do not add up.

    Many programs read word by word, so that lines mean nothing to them; the words of a sound file are used up exactly.
    """
    words = [word for row in table for word in row.words]
    lines = [row.line for row in table for _ in row.words]
    made, at = [], 0
    for element in header.elements.values():
        for _ in range(element.length):
            start = at
            for each in element.properties:
                word = words[at] if at < len(words) else ""
                if not word or (each.size and not (word.isascii() and word.isdecimal() and len(word) < 10)):
                    return None
                at += 1 + int(word) if each.size else 1
            if element.properties:
                made.append(Row(lines[start], words[start:at]))
    return made if at == len(words) else None


def _has_corners(element: Element) -> bool:
    place = element.find(*_CORNERS)
    return place >= 0 and bool(element.properties[place].size)


def _polygons(columns: Columns | None, n_vertices: int) -> Cells:
    if columns is None or not columns.element.length:
        return no_cells()
    sizes, corners = columns.lists(columns.element.find(*_CORNERS))
    outside = np.flatnonzero((corners < 0) | (corners >= n_vertices))
    if len(outside):
        face = int(np.searchsorted(np.cumsum(sizes), outside[0], side="right"))
        start = int(sizes[:face].sum())
        found = corners[start : start + min(int(sizes[face]), 8)]
        place = columns.place(face)
        raise IndexOutOfRange(f"{place} = {found} refers outside the {n_vertices} vertices")
    return sizes, corners


def _strips(columns: Columns) -> Cells:
    """Strips, which -1 ends, several in a list."""
    sizes, corners = columns.lists(columns.element.find(*_CORNERS))
    ends = np.zeros(len(corners), dtype=bool)
    ends[np.cumsum(sizes)[sizes > 0] - 1] = True  # a list ends a strip too
    stops = np.flatnonzero(ends | (corners == -1))
    lengths = np.diff(stops, prepend=-1)
    kept = corners != -1
    return np.asarray(lengths - ~kept[stops]), corners[kept]
