"""Where to look from: the source from a side that shows most of it, the target from the same side."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Floats
from gmds.maps.point_map import PointMap
from gmds.pictures.software import view_rotation

Direction = tuple[float, float, float]


def broadside(mesh: Mesh, up: Direction = (0, 0, 1), azimuth: float = 30.0, elevation: float = 12.0) -> Floats:
    """Camera rotation (3, 3), rows right, up, towards the viewer: looking at the mesh's broad side.

    `up` is up in the mesh's coordinates. The horizontal direction in which the mesh is thinnest points at the
    viewer, then the viewer walks `azimuth` degrees around and rises by `elevation` degrees.
    """
    z = np.array(up, dtype=np.float64)
    z /= np.linalg.norm(z)
    flat = mesh.vertices - mesh.vertices.mean(axis=0)
    flat = flat - np.outer(flat @ z, z)
    x = np.linalg.svd(flat / max(np.abs(flat).max(), 1e-300), full_matrices=False)[2][0]
    x -= (x @ z) * z  # a mesh has an area, so it is not a vertical line and x is a direction
    x *= np.sign(x[np.abs(x).argmax()]) / np.linalg.norm(x)
    return view_rotation(azimuth - 90, elevation) @ np.stack([x, np.cross(z, x), z])


def alignment(answer: PointMap) -> Floats:
    """The rotation (3, 3) of the target that brings it closest to the source under the map (Kabsch)."""
    rows = answer.valid
    if rows.sum() < 3:
        return np.eye(3)
    a, b = answer.source.vertices[rows], answer.points.positions[rows]
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    u, _, vt = np.linalg.svd((a.T / max(np.abs(a).max(), 1e-300)) @ (b / max(np.abs(b).max(), 1e-300)))
    u[:, 2] *= np.linalg.det(u) * np.linalg.det(vt)
    return u @ vt
