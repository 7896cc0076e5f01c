"""The whole surface larger or smaller."""

from __future__ import annotations

from geodesics import Mesh, SurfacePoints
from gmds.deformations.truths import moved


def global_scale(mesh: Mesh, factor: float) -> tuple[Mesh, SurfacePoints]:
    """The mesh times `factor` > 0 about the origin, and where its vertices went."""
    if not factor > 0:
        raise ValueError(f"factor must be positive, not {factor}")
    return moved(mesh, factor * mesh.vertices)
