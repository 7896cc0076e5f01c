"""A mesh as the page draws it: turned, of size one, and with no more vertices than a browser turns smoothly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from geodesics import Mesh
from geodesics.orientation import orient_faces
from gmds.geometry import decimated

Array = NDArray[np.float64]
Index = NDArray[np.int64]

MOST = 10_000  # vertices up to which a surface is drawn as it is
DRAWN = 8_000  # vertices, about, of what is drawn of a larger one
DIAMETER = 0.99  # of the ball that a surface is drawn in; the axes of the page are of length one


@dataclass(frozen=True, eq=False)
class Drawing:
    """What is drawn of a mesh: `vertices` (k, 3) and `faces`, and `origin` (k,), the vertex that each stands for."""

    vertices: Array
    faces: Index
    origin: Index
    center: Array
    axes: Array

    def placed(self, points: Array) -> NDArray[np.float32]:
        """Points (p, 3) near the mesh where they are drawn: turned, in a ball of diameter one about the origin."""
        return ((np.asarray(points) - self.center) @ self.axes.T).astype(np.float32)


def drawing(mesh: Mesh, rotation: Array) -> Drawing:
    """The mesh itself up to `MOST` vertices; else a copy of some `DRAWN`, whose vertices stand for the nearest ones."""
    used = np.unique(mesh.faces)
    v = mesh.vertices[used]
    center = (v.min(axis=0) + v.max(axis=0)) / 2
    axes = rotation * (DIAMETER / 2 / (np.linalg.norm(v - center, axis=1).max() or 1.0))
    oriented = orient_faces(mesh)  # or light would fall on some faces from within
    if mesh.n_vertices <= MOST:
        return Drawing(mesh.vertices, oriented.faces, np.arange(mesh.n_vertices), center, axes)
    copy = decimated(oriented, 2 * DRAWN) or clustered(oriented, MOST)
    return Drawing(copy.vertices, copy.faces, used[cKDTree(v).query(copy.vertices)[1]], center, axes)


def clustered(mesh: Mesh, n_vertices: int) -> Mesh:
    """The mesh with all vertices in a cell of a grid made one, whatever its defects: at most about `n_vertices`."""
    used = np.unique(mesh.faces)
    v = mesh.vertices[used] - mesh.vertices[used].min(axis=0)
    v /= v.max() or 1.0
    coarse, fine = 2, 2048
    while fine - coarse > max(1, coarse // 20):
        middle = (coarse + fine) // 2
        few = len(np.unique(_cells(v, middle))) <= n_vertices
        coarse, fine = (middle, fine) if few else (coarse, middle)
    _, first, member = np.unique(_cells(v, coarse), return_index=True, return_inverse=True)
    new = np.empty(mesh.n_vertices, dtype=np.int64)
    new[used] = member.reshape(-1)
    faces = new[mesh.faces]
    proper = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return Mesh(mesh.vertices[used[first]], np.unique(faces[proper], axis=0) if proper.any() else faces[:1])


def _cells(v: Array, finer: int) -> Index:
    """The number of the cell of each of the points (n, 3) in [0, 1], in a grid of `finer` cells a side."""
    return np.minimum((v * finer).astype(np.int64), finer - 1) @ [1, finer, finer * finer]
