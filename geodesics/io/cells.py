"""Cells of VTK, and strips as PLY and GLB have them too, as polygons."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.errors import BadCount, IndexOutOfRange, UnknownFormat
from geodesics.io.contents import Contents
from geodesics.io.polygons import split
from geodesics.notes import Note

Cells = tuple[Integers, Integers]  # how many vertices each cell has (m,), and all of them (c,)

# Numbers of cell types in vtkCellType.h: what is a polygon, a strip, and what has no area and is passed over.
POLYGONS, PIXEL, STRIP, THIN = (5, 7, 9), 8, 6, (0, 1, 2, 3, 4, 21, 35)


def no_cells() -> Cells:
    """None at all."""
    return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)


def joined(parts: list[Cells]) -> Cells:
    """Several lists of cells as one."""
    sizes, corners = zip(no_cells(), *parts, strict=True)
    return np.concatenate(sizes), np.concatenate(corners)


def from_offsets(offsets: Integers, connectivity: Integers, path: Path) -> Cells:
    """Cells whose ends in `connectivity` are given; `BadCount` unless they rise from 0 to its length."""
    sizes = np.diff(offsets)
    if len(offsets) == 0 or offsets[0] != 0 or (sizes < 0).any() or offsets[-1] != len(connectivity):
        raise BadCount(
            f"{path}: the offsets of cells do not rise from 0 to the {len(connectivity)} corners that follow"
        )
    return np.asarray(sizes), connectivity


def from_counts(flat: Integers, n_cells: int, path: Path) -> Cells:
    """Cells that each begin with their number of vertices, [3, i, j, k, 4, ...]."""
    where, at, values = np.empty(n_cells, dtype=np.int64), 0, flat.tolist()
    for cell in range(n_cells):
        if at >= len(values) or values[at] < 0:
            raise BadCount(
                f"{path}: cell {cell} of {n_cells} does not begin within the {len(flat)} numbers of its list"
            )
        where[cell] = at
        at += 1 + values[at]
    if at != len(flat):
        raise BadCount(f"{path}: {n_cells} cells take {at} numbers, and {len(flat)} are declared")
    keep = np.ones(len(flat), dtype=bool)
    keep[where] = False
    return flat[where], flat[keep]


def of_types(cells: Cells, types: Integers, path: Path) -> tuple[Cells, Cells]:
    """The polygons and the strips among cells of an unstructured grid; `UnknownFormat` for solid ones."""
    known = np.isin(types, [*POLYGONS, PIXEL, STRIP, *THIN])
    if len(types) != len(cells[0]):
        raise BadCount(f"{path}: {len(types)} types for {len(cells[0])} cells")
    if not known.all():
        raise UnknownFormat(
            f"{path}: cell {int(np.argmin(known))} is of VTK's type {types[np.argmin(known)]}, no plain polygon; "
            "extract the surface and save it as PolyData"
        )
    sizes, corners = cells
    pixel = np.flatnonzero((types == PIXEL) & (sizes == 4))
    last = (np.cumsum(sizes) - 1)[pixel]
    corners = corners.copy()
    corners[last], corners[last - 1] = corners[last - 1], corners[last]
    polygon, strip = np.isin(types, [*POLYGONS, PIXEL]), types == STRIP
    return tuple((sizes[kind], corners[np.repeat(kind, sizes)]) for kind in (polygon, strip))  # type: ignore[return-value]


def triangles_of_strips(strips: Cells) -> Integers:
    """Triangles (t, 3) of strips of vertices, every other one turned, those that name a vertex twice left out."""
    sizes, corners = strips
    many = np.maximum(sizes - 2, 0)
    first = np.repeat(np.cumsum(sizes) - sizes, many)
    step = np.arange(many.sum()) - np.repeat(np.cumsum(many) - many, many)
    at = first + step
    turned = step % 2
    found = np.column_stack([corners[at + turned], corners[at + 1 - turned], corners[at + 2]]) if len(at) else at
    found = found.reshape(-1, 3)
    return np.asarray(found[(found != np.roll(found, 1, axis=1)).all(axis=1)])


def check_corners(cells: Cells, n_vertices: int, path: Path) -> None:
    """`IndexOutOfRange` naming the first cell with a corner that is no vertex."""
    sizes, corners = cells
    outside = np.flatnonzero((corners < 0) | (corners >= n_vertices))
    if len(outside):
        cell = int(np.searchsorted(np.cumsum(sizes), outside[0], side="right"))
        start = int(sizes[:cell].sum())
        face = corners[start : start + min(int(sizes[cell]), 8)]
        raise IndexOutOfRange(f"{path}: face {cell} = {face} refers outside the {n_vertices} vertices")


def surface(vertices: Floats, polygons: Cells, strips: Cells, path: Path, notes: list[Note]) -> Contents:
    """Polygons, then strips, as contents; every index is checked."""
    for cells in (polygons, strips):
        check_corners(cells, len(vertices), path)
    triangles, slots, split_notes = split(*polygons, vertices)
    ribbons = triangles_of_strips(strips)
    if len(ribbons):
        split_notes.append(Note("W210", "info", f"{len(strips[0])} strips were split into {len(ribbons)} triangles"))
        return Contents(vertices, np.concatenate([triangles, ribbons]), [*notes, *split_notes])
    return Contents(vertices, triangles, [*notes, *split_notes], slots=slots, polygons=polygons)
