"""Holes closed by cones, for distances that do not go round them."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from geodesics.mesh import Mesh
from geodesics.topology.edges import components, edges


def capped(mesh: Mesh, longest: float) -> Mesh:
    """The mesh with a cone over the centroid of every piece of boundary that is at most `longest` long.

    Vertices and faces stay; one new vertex a piece and one new face an edge of it come last. A piece is a connected
    part of the boundary, so that pinched ones need no order. Distances on the result are those across the hole, as if
    it were flat; the orientation of the new faces is that of their neighbours.
    """
    table = edges(mesh)
    alone = np.flatnonzero(table.n_faces == 1)
    if len(alone) == 0:
        return mesh
    side = np.flatnonzero(np.isin(table.of_side.ravel(), alone))
    face, corner = side // 3, side % 3
    start, end = mesh.faces[face, corner], mesh.faces[face, (corner + 1) % 3]
    piece = components(start, end, mesh.n_vertices)[start]
    _, piece = np.unique(piece, return_inverse=True)
    length = np.linalg.norm(mesh.vertices[start] - mesh.vertices[end], axis=1)
    total = np.bincount(piece, length)
    closed = total <= longest
    number = np.cumsum(closed) - 1
    kept = closed[piece]
    centers = _weighted_means((mesh.vertices[start] + mesh.vertices[end]) / 2, length, piece)[closed]
    top = mesh.n_vertices + number[piece[kept]]
    faces = np.column_stack([end[kept], start[kept], top])
    return Mesh(np.vstack([mesh.vertices, centers]), np.vstack([mesh.faces, faces]))


def _weighted_means(points: Floats, weights: Floats, group: np.ndarray) -> Floats:
    """Weighted means (g, 3) of points (p, 3) over groups (p,) numbered from 0."""
    total = np.bincount(group, weights)
    sums = [np.bincount(group, weights * points[:, k]) for k in range(3)]
    return np.column_stack(sums) / total[:, None]
