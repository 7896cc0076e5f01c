"""What is left of a mesh when faces are taken away."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Integers
from geodesics.topology.components import largest_component
from gmds.deformations.truths import Part


def largest_piece(mesh: Mesh, faces: Integers, *, by_area: bool = True) -> Integers:
    """Of some faces of a mesh the component of the most area, or of the most faces; none of none.

    Vertices at which only corners of faces would touch, and did not before, go with their faces.
    """
    faces = _without_bow_ties(faces, mesh.faces)
    if len(faces) == 0:
        return faces
    weights = None if by_area else np.ones(len(faces))
    return faces[largest_component(Mesh(mesh.vertices, faces), weights)]


def part(mesh: Mesh, faces: Integers) -> Part:
    """Some faces of a mesh as a mesh: vertices keep their order, and the truth of those that remain is exact."""
    kept, renumbered = np.unique(faces, return_inverse=True)
    result = Mesh(mesh.vertices[kept], renumbered.reshape(-1, 3))
    truth = SurfacePoints.closest(result, mesh.vertices)
    face, barycentric = truth.face.copy(), truth.barycentric.copy()
    exact = SurfacePoints.at_vertices(result, np.arange(result.n_vertices))
    face[kept], barycentric[kept] = exact.face, exact.barycentric
    missing = np.ones(mesh.n_vertices, dtype=bool)
    missing[kept] = False
    return Part(result, SurfacePoints(result, face, barycentric), missing)


def _without_bow_ties(faces: Integers, before: Integers) -> Integers:
    """The faces without those at vertices that are not manifold now and were before."""
    import igl

    fine = np.asarray(igl.is_vertex_manifold(before))
    while len(faces):
        now = np.asarray(igl.is_vertex_manifold(faces))
        torn = np.flatnonzero(fine[: len(now)] & ~now)
        torn = torn[np.isin(torn, faces)]
        if len(torn) == 0:
            break
        faces = faces[~np.isin(faces, torn).any(axis=1)]
    return faces
