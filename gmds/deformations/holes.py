"""Holes cut into the surface."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh
from geodesics.errors import BadArgument
from geodesics.topology.edge_paths import edge_distances
from gmds.deformations.kept_faces import largest_piece, part
from gmds.deformations.truths import Part


def holes(mesh: Mesh, count: int = 5, *, radius: float = 0.05, rng: int = 0) -> Part:
    """Cut holes around random vertices.

    Vertices at which two holes meet are removed as well, and only the component of the most faces is kept. Remaining
    vertices keep their order, and their truth is exact; a removed vertex gets the remaining point closest in space.

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
        n points of it, one per vertex of the old mesh. `Part.missing` says which of them are gone.

    Raises
    ------
    ValueError
        When nothing is left.
    """
    mesh = Mesh.from_object(mesh)
    random = np.random.default_rng(rng)
    centres = random.permutation(mesh.n_vertices)[:count]
    distance = edge_distances(mesh, centres).min(axis=0) if count else np.full(mesh.n_vertices, np.inf)
    faces = mesh.faces[(distance > radius * np.sqrt(mesh.area))[mesh.faces].all(axis=1)]
    faces = largest_piece(mesh, faces, by_area=False)
    if len(faces) == 0:
        raise BadArgument(f"{count} holes of radius {radius} leave nothing; ask for fewer or smaller ones")
    return part(mesh, faces)
