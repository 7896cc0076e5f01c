"""Turned, moved and resized at random."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from geodesics import Mesh, SurfacePoints
from gmds.deformations.truths import moved


def similarity(mesh: Mesh, *, largest_scale: float = 1.0, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """The mesh under a random rotation, a shift of up to its extent, and a scale from 1/largest to largest."""
    if not largest_scale >= 1:
        raise ValueError(f"largest_scale must be at least 1, not {largest_scale}")
    random = np.random.default_rng(rng)
    turn = Rotation.random(random_state=random)
    scale = largest_scale ** random.uniform(-1, 1)
    shift = random.uniform(-1, 1, 3) * np.ptp(mesh.vertices, axis=0).max()
    return moved(mesh, scale * mesh.vertices @ turn.as_matrix().T + shift)
