"""Noise on few vertices, but strong."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh, SurfacePoints, vertex_normals
from gmds.deformations.noise import mean_edge_length
from gmds.deformations.truths import moved


def shot_noise(mesh: Mesh, strength: float = 2.0, *, share: float = 0.01, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """A `share` of the vertices moved along their normals, in or out, by up to `strength` mean edge lengths."""
    random = np.random.default_rng(rng)
    hit = random.permutation(mesh.n_vertices)[: round(share * mesh.n_vertices)]
    height = np.zeros(mesh.n_vertices)
    height[hit] = (
        random.uniform(0.5, 1, len(hit)) * random.choice([-1, 1], len(hit)) * strength * mean_edge_length(mesh)
    )
    return moved(mesh, mesh.vertices + height[:, None] * vertex_normals(mesh))
