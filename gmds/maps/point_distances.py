"""How far apart points of one surface are, pair by pair."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Bools, Floats
from geodesics.distance import Distance
from geodesics.points import SurfacePoints

CHUNK = 64  # points marched from at once: a bound of memory, CHUNK times the vertices; no distance depends on it


def distances_between(points: SurfacePoints, others: SurfacePoints, distance: Distance) -> Floats:
    """The distance (p,) from each of p points to its partner among the `others` on the same mesh.

    One field for each distinct partner, linear on faces; straight in space where both points are on one face. Where the
    partner is out of reach, on another component, the largest distance that is within its reach.
    """
    straight = np.linalg.norm(points.positions - others.positions, axis=1)
    return np.where(_on_one_face(points, others), straight, _marched(points, others, distance))


def _marched(points: SurfacePoints, others: SurfacePoints, distance: Distance) -> Floats:
    """Distance (p,) by linear interpolation of one field for each distinct partner."""
    _, first, which = np.unique(
        np.column_stack([others.face, others.barycentric]), axis=0, return_index=True, return_inverse=True
    )
    which = which.reshape(-1)
    corners = points.mesh.faces[points.face]
    result = np.empty(len(points))
    for start in range(0, len(first), CHUNK):
        field = distance.field(others[first[start : start + CHUNK]])
        reach = np.where(np.isfinite(field), field, -1).max(axis=1, keepdims=True)
        field = np.where(np.isfinite(field), field, reach)
        rows = np.flatnonzero((which >= start) & (which < start + CHUNK))
        values = field[(which[rows] - start)[:, None], corners[rows]]
        result[rows] = (values * points.barycentric[rows]).sum(axis=1)
    return result


def _on_one_face(points: SurfacePoints, others: SurfacePoints) -> Bools:
    """True where every corner that carries the partner is a corner of the point's face, (p,)."""
    here, there = points.mesh.faces[points.face], others.mesh.faces[others.face]
    shared = (there[:, :, None] == here[:, None, :]).any(axis=2)
    return (shared | (others.barycentric <= 0)).all(axis=1)
