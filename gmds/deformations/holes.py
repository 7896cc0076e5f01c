"""Holes cut into the surface."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Integers
from geodesics.topology.components import largest_component
from gmds.deformations.limbs import edge_distances


def holes(mesh: Mesh, count: int = 5, *, radius: float = 0.05, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """Cut holes around random vertices.

    Vertices at which two holes meet are removed as well, and only the component of the most faces is kept. Remaining
    vertices keep their order, and their truth is exact; a removed vertex gets the remaining point closest in space, and
    the distance between the two says that it was removed.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    count : int
        Holes.
    radius : float
        In units of the square root of the area, along edges; 0 removes single vertices with their ring of faces.
    rng : int
        Seed of the random choices.

    Returns
    -------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh.

    Raises
    ------
    ValueError
        When nothing is left.
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
