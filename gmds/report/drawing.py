"""A mesh as the page draws it: turned, of size one, and with no more vertices than a browser turns smoothly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from geodesics import Mesh
from geodesics.arrays import Floats, Integers
from geodesics.repair.clustering import clustered
from geodesics.repair.decimation import decimated
from geodesics.topology.orientation import orient_faces

# how a browser turns both is in benchmarks/results/page_speed.md
MOST_VERTICES = 12_000  # vertices up to which a surface is drawn as it is
SIMPLIFIED_VERTICES = 8_000  # vertices, about, of what is drawn of a larger one
DIAMETER = 0.99  # of the ball that a surface is drawn in; a little less than the axes of the page, whose length is 1


@dataclass(frozen=True, eq=False)
class Drawing:
    """What is drawn of a mesh: `vertices` (k, 3) and `faces`, and `origin` (k,), the vertex that each stands for."""

    vertices: Floats
    faces: Integers
    origin: Integers
    center: Floats
    axes: Floats

    def placed(self, points: Floats) -> NDArray[np.float32]:
        """Points (p, 3) near the mesh where they are drawn: turned, in a ball of diameter one about the origin."""
        return ((np.asarray(points) - self.center) @ self.axes.T).astype(np.float32)

    def given(self, drawn: Floats) -> Floats:
        """Places (p, 3) of the mesh from where they are drawn, the opposite of `placed`."""
        return np.asarray(drawn, dtype=np.float64) @ np.linalg.inv(self.axes).T + self.center

    @property
    def unit(self) -> float:
        """How many units of the mesh one of the drawing is."""
        return float(1 / np.linalg.norm(self.axes[0]))


def drawing(mesh: Mesh, rotation: Floats) -> Drawing:
    """The mesh itself up to `MOST_VERTICES`; else a copy with about `SIMPLIFIED_VERTICES`."""
    used = np.unique(mesh.faces)
    v = mesh.vertices[used]
    center = (v.min(axis=0) + v.max(axis=0)) / 2
    axes = rotation * (DIAMETER / 2 / (np.linalg.norm(v - center, axis=1).max() or 1.0))
    oriented = orient_faces(mesh)  # or light would fall on some faces from within
    if mesh.n_vertices <= MOST_VERTICES:
        return Drawing(mesh.vertices, oriented.faces, np.arange(mesh.n_vertices), center, axes)
    copy = decimated(oriented, 2 * SIMPLIFIED_VERTICES) or clustered(oriented, MOST_VERTICES)
    return Drawing(copy.vertices, copy.faces, used[cKDTree(v).query(copy.vertices)[1]], center, axes)
