"""Pieces cut out."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Integers
from geodesics.topology.components import largest_component
from gmds.deformations.limbs import edge_distances


def holes(mesh: Mesh, count: int = 5, *, radius: float = 0.05, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """The mesh without the vertices nearer than `radius` sqrt(area) to `count` random ones; radius 0 cuts single rings.

    Vertices at which two holes meet go as well, and only the largest connected piece is kept. Vertices that are left
    keep their order and their truth is exact; a lost vertex gets the point of the rest closest in space, at a distance
    from its own place that says that it is lost.
    Raises ValueError when nothing is left.
    """
    random = np.random.default_rng(rng)
    centres = random.permutation(mesh.n_vertices)[:count]
    distance = edge_distances(mesh, centres).min(axis=0) if count else np.full(mesh.n_vertices, np.inf)
    faces = mesh.faces[(distance > radius * np.sqrt(mesh.area))[mesh.faces].all(axis=1)]
    faces = _without_bow_ties(faces, mesh.faces)
    if len(faces) == 0:
        raise ValueError(f"{count} holes of radius {radius} leave nothing; ask for fewer or smaller ones")
    faces = faces[largest_component(Mesh(mesh.vertices, faces), weights=np.ones(len(faces)))]
    kept, renumbered = np.unique(faces, return_inverse=True)
    result = Mesh(mesh.vertices[kept], renumbered.reshape(-1, 3))
    truth = SurfacePoints.closest(result, mesh.vertices)
    face, barycentric = truth.face.copy(), truth.barycentric.copy()
    exact = SurfacePoints.at_vertices(result, np.arange(result.n_vertices))
    face[kept], barycentric[kept] = exact.face, exact.barycentric
    return result, SurfacePoints(result, face, barycentric)


def _without_bow_ties(faces: Integers, before: Integers) -> Integers:
    """The faces without those at vertices where sheets meet now and did not before."""
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
