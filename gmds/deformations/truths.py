"""Truth that travels: where every vertex of a mesh is on its deformed copy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh, SurfacePoints
from geodesics.barycentric import combination

Deformation = Callable[[Mesh], tuple[Mesh, SurfacePoints]]


def moved(mesh: Mesh, vertices: ArrayLike) -> tuple[Mesh, SurfacePoints]:
    """The mesh with its vertices (n, 3) elsewhere; vertex i stays vertex i.

    Raises `MeshError` where a vertex is on no face: it has no surface point.
    """
    result = Mesh(vertices, mesh.faces)
    return result, SurfacePoints.at_vertices(result, np.arange(mesh.n_vertices))


def carried(points: SurfacePoints, truth: SurfacePoints) -> SurfacePoints:
    """Points (p) of a mesh carried to its deformed copy by the truth of the mesh's vertices.

    Exact where the copy has the same faces and vertex i is still vertex i; else the surface point closest in space to
    the weighted mean of the images of the face's corners.
    """
    same_faces = np.array_equal(points.mesh.faces, truth.mesh.faces)
    if same_faces and np.array_equal(truth.positions, truth.mesh.vertices):
        return SurfacePoints(truth.mesh, points.face, points.barycentric)
    corners = truth.positions[points.mesh.faces[points.face]]
    return SurfacePoints.closest(truth.mesh, combination(points.barycentric, corners))


def compose(*deformations: Deformation) -> Deformation:
    """The deformations one after another, first to last, as one deformation with its truth carried through."""

    def together(mesh: Mesh) -> tuple[Mesh, SurfacePoints]:
        result, truth = moved(mesh, mesh.vertices)
        for deformation in deformations:
            result, step = deformation(result)
            truth = carried(truth, step)
        return result, truth

    return together
