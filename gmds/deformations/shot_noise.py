"""Strong noise on few vertices."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh, SurfacePoints, vertex_normals
from gmds.deformations.noise import mean_edge_length
from gmds.deformations.truths import moved


def shot_noise(mesh: Mesh, strength: float = 2.0, *, share: float = 0.01, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """Move a few vertices far along their normals, in or out.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    strength : float
        Largest displacement in mean edge lengths; the smallest is half of it.
    share : float
        Share of the vertices that are moved.
    rng : int
        Seed of the random choices.

    Returns
    -------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh.

    See Also
    --------
    noise : All vertices, but less.
    """
    mesh = Mesh.from_object(mesh)
    random = np.random.default_rng(rng)
    hit = random.permutation(mesh.n_vertices)[: round(share * mesh.n_vertices)]
    height = np.zeros(mesh.n_vertices)
    height[hit] = (
        random.uniform(0.5, 1, len(hit)) * random.choice([-1, 1], len(hit)) * strength * mean_edge_length(mesh)
    )
    return moved(mesh, mesh.vertices + height[:, None] * vertex_normals(mesh))
