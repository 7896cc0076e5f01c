"""A random similarity: rotation, translation and scale."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from geodesics import Mesh, SurfacePoints
from geodesics.errors import BadArgument
from gmds.deformations.truths import moved


def similarity(mesh: Mesh, *, largest_scale: float = 1.0, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """Move the mesh by a random rotation, translation and scale.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    largest_scale : float
        The scale is between 1 / largest_scale and largest_scale, uniform in its logarithm; at least 1.
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
        When `largest_scale` is less than 1.
    """
    mesh = Mesh.from_object(mesh)
    if not largest_scale >= 1:
        raise BadArgument(f"largest_scale must be at least 1, not {largest_scale}")
    random = np.random.default_rng(rng)
    turn = Rotation.random(random_state=random)
    scale = largest_scale ** random.uniform(-1, 1)
    shift = random.uniform(-1, 1, 3) * np.ptp(mesh.vertices, axis=0).max()
    return moved(mesh, scale * mesh.vertices @ turn.as_matrix().T + shift)
