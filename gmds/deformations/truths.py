"""Truth along deformations: where every vertex of a mesh is on its deformed copy."""

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
    """Points of a mesh on its deformed copy, given the truth of the mesh's vertices.

    Exact where the copy has the same faces and vertex i is still vertex i; else the surface point closest in space to
    the weighted mean of the images of the face's corners.

    Parameters
    ----------
    points : SurfacePoints
        p points of the mesh.
    truth : SurfacePoints
        One point of the copy per vertex of the mesh.

    Returns
    -------
    SurfacePoints
        p points of the copy.
    """
    same_faces = np.array_equal(points.mesh.faces, truth.mesh.faces)
    if same_faces and np.array_equal(truth.positions, truth.mesh.vertices):
        return SurfacePoints(truth.mesh, points.face, points.barycentric)
    corners = truth.positions[points.mesh.faces[points.face]]
    return SurfacePoints.closest(truth.mesh, combination(points.barycentric, corners))


def compose(*deformations: Deformation) -> Deformation:
    """Several deformations, one after another, as one.

    Parameters
    ----------
    *deformations : callable
        Each Mesh -> (Mesh, SurfacePoints); the first is applied first.

    Returns
    -------
    callable
        Mesh -> (Mesh, SurfacePoints), with the truth of the first mesh's vertices on the last mesh.
    """

    def together(mesh: Mesh) -> tuple[Mesh, SurfacePoints]:
        result, truth = moved(mesh, mesh.vertices)
        for deformation in deformations:
            result, step = deformation(result)
            truth = carried(truth, step)
        return result, truth

    return together
