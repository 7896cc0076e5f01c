"""Polygons split into triangles without a new vertex: about the first corner, or by clipping ears where that overlaps.

Vertices count as they lie in space: a polygon is looked at along its normal, the sum of the cross products of its
sides, so that one that is nearly flat is as good as one that is.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.errors import BadPolygon
from geodesics.notes import Note

LARGEST_CLIPPED = 1000  # corners; the time to clip one is at worst their square, a bound of seconds, set by hand
OVERLAP = 1e-9  # of a polygon's area that triangles may lie the wrong way round, for corners in a line; set by hand


def split(
    sizes: Integers | Sequence[int], corners: Integers | Sequence[int], vertices: Floats
) -> tuple[Integers, Integers, list[Note]]:
    """Triangles (t, 3) of polygons, their slots (t, 3) and notes (W210, W223); polygons stay in order.

    `sizes` (m,) says how many of the vertices in `corners` (c,) belong to each polygon; those of fewer than three have
    no triangle. A slot is a place in `corners`: `triangles == corners[slots]`. A convex polygon is split about its
    first corner.
    """
    count, flat = np.asarray(sizes, dtype=np.int64), np.asarray(corners, dtype=np.int64)
    start = np.cumsum(count) - count
    many = triangles_of(count)
    first = np.cumsum(many) - many  # triangle of each polygon
    slots = np.empty((int(many.sum()), 3), dtype=np.int64)
    clipped: list[int] = []
    for size in np.unique(count[count > 2]).tolist():
        members = np.flatnonzero(count == size)
        fan = np.array([(0, i, i + 1) for i in range(1, size - 1)])
        where = first[members, None] + np.arange(size - 2)
        slots[where] = start[members, None, None] + fan
        if size > 3:
            clipped += members[_overlapping(vertices[flat[start[members, None] + np.arange(size)]])].tolist()
    for polygon in clipped:
        at, size = int(start[polygon]), int(count[polygon])
        if size > LARGEST_CLIPPED:
            raise BadPolygon(
                f"face {polygon} has {size} corners and is not convex; cut it into triangles where it was made"
            )
        ears = clip_ears(_flattened(vertices[flat[at : at + size]]))
        slots[first[polygon] : first[polygon] + size - 2] = at + ears
    return flat[slots].reshape(-1, 3), slots, _notes(count, len(clipped))


def triangles_of(sizes: Integers) -> Integers:
    """How many triangles each polygon makes."""
    return np.asarray(np.maximum(sizes - 2, 0))


def _notes(count: Integers, clipped: int) -> list[Note]:
    notes = []
    larger, smaller = np.flatnonzero(count > 3), np.flatnonzero(count < 3)
    if len(larger):
        how = f", {clipped} of them not convex" if clipped else ""
        message = f"{len(larger)} of {len(count)} faces have more than three corners{how} and were split into triangles"
        notes.append(Note("W210", "info", message, tuple(larger[:10].tolist()), len(larger)))
    if len(smaller):
        message = f"{len(smaller)} of {len(count)} faces have fewer than three corners, as edges do, and were left out"
        notes.append(Note("W223", "info", message, tuple(smaller[:10].tolist()), len(smaller)))
    return notes


def _overlapping(points: Floats) -> Integers:
    """Which polygons (g, k, 3) have a triangle about the first corner that is turned against the others."""
    with np.errstate(all="ignore"):  # a corner may be NaN, or too large to square: that is refused later
        rays = points[:, 1:] - points[:, :1]
        area = np.cross(rays[:, :-1], rays[:, 1:])
        normal = area.sum(axis=1)
        along = np.einsum("gkj,gj->gk", area, normal)
        return np.flatnonzero((along < -OVERLAP * (normal**2).sum(axis=1, keepdims=True)).any(axis=1))


def _flattened(points: Floats) -> Floats:
    """A polygon (k, 3) as it is seen along its normal, (k, 2), counter-clockwise and of size one."""
    rays = points - points[0]
    rays = rays / np.abs(rays).max()
    normal = np.cross(rays[1:-1], rays[2:]).sum(axis=0)
    normal /= np.linalg.norm(normal)
    other = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    other /= np.linalg.norm(other)
    return np.asarray(np.column_stack([rays @ other, rays @ np.cross(normal, other)]), dtype=np.float64)


def clip_ears(points: Floats) -> Integers:
    """Triangles (k - 2, 3) of a counter-clockwise polygon (k, 2), which may be concave or touch itself.

    An ear is a convex corner whose triangle holds no other corner. Where there is none, as the sides cross, the corner
    that turns most is taken, so that there always is an answer.
    """
    left, triangles = list(range(len(points))), []
    at = 0
    while len(left) > 3:
        size = len(left)
        for step in range(size):
            here = (at + step) % size
            if _is_ear(points, left, here):
                break
        else:
            here = int(np.argmax(_turns(points[left])))
        triangles.append((left[here - 1], left[here], left[(here + 1) % size]))
        del left[here]
        at = here % (size - 1)
    return np.array([*triangles, tuple(left)], dtype=np.int64)


def _turns(loop: Floats) -> Floats:
    """Twice the signed area of each corner with its neighbours, (k,)."""
    return _twice_area(np.roll(loop, 1, axis=0), loop, np.roll(loop, -1, axis=0))


def _twice_area(a: Floats, b: Floats, c: Floats) -> Floats:
    u, v = b - a, c - a
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0], dtype=np.float64)


def _is_ear(points: Floats, left: list[int], here: int) -> bool:
    a, b, c = points[left[here - 1]], points[left[here]], points[left[(here + 1) % len(left)]]
    if _twice_area(a, b, c) <= 0:
        return False
    others = points[left]
    inside = (_twice_area(a, b, others) >= 0) & (_twice_area(b, c, others) >= 0) & (_twice_area(c, a, others) >= 0)
    corner = (others == a).all(axis=1) | (others == b).all(axis=1) | (others == c).all(axis=1)
    return not bool((inside & ~corner).any())
