"""Lines drawn on a surface: where values are round, and where labels meet."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh
from geodesics.arrays import Floats, Integers

RADIUS = 0.0025  # of a line, in square roots of the area: two pixels of a picture of the usual size; set by hand
LINES = 12  # about so many isolines from the least to the largest value; set by hand
STEPS = (1.0, 2.0, 5.0, 10.0)  # of round numbers, as axes have
SIDES = np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]])  # of a prism on three corners


def round_levels(low: float, high: float) -> Floats:
    """Multiples of 1, 2 or 5 times a power of ten within (low, high), about `LINES` of them; none in an empty range."""
    if not high > low:
        return np.empty(0)
    wide = (high - low) / LINES
    power = 10.0 ** np.floor(np.log10(wide))
    step = power * next(factor for factor in STEPS if factor * power >= wide * (1 - 1e-9))
    levels = step * np.arange(np.ceil(low / step), np.floor(high / step) + 1)
    return np.asarray(levels[(levels > low) & (levels < high)], dtype=np.float64)


def isolines(mesh: Mesh, values: ArrayLike, levels: ArrayLike) -> Floats:
    """Segments (k, 2, 3) where values (n,), linear on each face, take one of the levels; none where not finite."""
    corner = np.asarray(values, dtype=np.float64)[mesh.faces]
    finite = np.isfinite(corner).all(axis=1)
    corner, places = corner[finite], mesh.vertices[mesh.faces[finite]]
    found = [np.empty((0, 2, 3))]
    for level in np.asarray(levels, dtype=np.float64).tolist():
        above = corner >= level
        rows = np.flatnonzero(above.any(axis=1) & ~above.all(axis=1))
        value, place = corner[rows] - level, places[rows]
        odd = np.where(above[rows].sum(axis=1) == 1, above[rows].argmax(axis=1), above[rows].argmin(axis=1))
        ends = [_crossing(value, place, odd, (odd + turn) % 3) for turn in (1, 2)]
        found.append(np.stack(ends, axis=1))
    return np.concatenate(found)


def borders(mesh: Mesh, labels: ArrayLike) -> Floats:
    """Segments (k, 2, 3) between places whose nearest corner of a face has another label (n,)."""
    label = np.asarray(labels)[mesh.faces]
    place = mesh.vertices[mesh.faces]
    middle = (place + np.roll(place, -1, axis=1)) / 2  # of the edges, from each corner to the next
    differ = label != np.roll(label, -1, axis=1)
    centre = np.broadcast_to(place.mean(axis=1)[:, None], middle.shape)
    return np.stack([middle[differ], centre[differ]], axis=1)


def with_lines(mesh: Mesh, colours: Floats, segments: Floats, ink: ArrayLike) -> tuple[Mesh, Floats]:
    """The mesh with a thin prism along each segment (k, 2, 3), and the colours of all its vertices; `ink` is sRGB."""
    way = segments[:, 1] - segments[:, 0]
    length = np.linalg.norm(way, axis=1)
    segments, way = segments[length > 0], way[length > 0] / length[length > 0, None]
    aside = np.cross(way, np.eye(3)[np.abs(way).argmin(axis=1)])
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    above = np.cross(way, aside)
    angle = 2 * np.pi * np.arange(3) / 3
    around = np.cos(angle)[None, :, None] * aside[:, None] + np.sin(angle)[None, :, None] * above[:, None]
    corners = segments[:, :, None] + RADIUS * np.sqrt(mesh.area) * around[:, None]  # (k, 2, 3 corners, 3)
    k = len(segments)
    faces = mesh.n_vertices + 6 * np.arange(k)[:, None, None] + SIDES
    shape = Mesh(
        np.vstack([mesh.vertices, corners.reshape(-1, 3)]),
        np.vstack([mesh.faces, faces.reshape(-1, 3)]),
    )
    return shape, np.vstack([colours, np.broadcast_to(np.asarray(ink), (6 * k, 3))])


def _crossing(value: Floats, place: Floats, one: Integers, other: Integers) -> Floats:
    """Where the edge between two corners of each face is zero."""
    row = np.arange(len(value))
    share = value[row, one] / (value[row, one] - value[row, other])
    return np.asarray(place[row, one] + share[:, None] * (place[row, other] - place[row, one]), dtype=np.float64)
