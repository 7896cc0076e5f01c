"""Noise on every vertex."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh, SurfacePoints, intrinsic, vertex_normals
from gmds.deformations.truths import moved


def noise(mesh: Mesh, strength: float = 0.2, *, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """Move every vertex along its normal by Gaussian noise.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    strength : float
        Standard deviation in mean edge lengths.
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
    shot_noise : Few vertices, but far.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> rough, true = gmds.noise(animal, 0.1)
    >>> rough.n_faces == animal.n_faces
    True
    """
    mesh = Mesh.from_object(mesh)
    step = strength * mean_edge_length(mesh)
    height = np.random.default_rng(rng).normal(0, step, mesh.n_vertices)
    return moved(mesh, mesh.vertices + height[:, None] * vertex_normals(mesh))


def mean_edge_length(mesh: Mesh) -> float:
    """The mean length of the edges, each counted once per face."""
    return float(np.sqrt(intrinsic.squared_lengths(mesh.vertices, mesh.faces)).mean())
