"""Points of a measured surface as points of the mesh that was measured."""

from __future__ import annotations

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Floats, Integers
from gmds.surface.measured import Surface


def on_original(surface: Surface, points: SurfacePoints) -> SurfacePoints:
    """Points of a measured surface as points of the mesh that was measured."""
    face, weight = surface.face_index[points.face], points.barycentric
    weight = turned_back(weight, surface.mesh.faces[points.face], surface.original.faces[face])
    return SurfacePoints(surface.original, face, weight)


def turned_back(weights: Floats, corners: Integers, others: Integers) -> Floats:
    """Weights (p, 3) of corners (p, 3) as weights of the same corners in another order; the first stays the first."""
    swapped = (corners != others).any(axis=1, keepdims=True)
    return np.where(swapped, weights[:, [0, 2, 1]], weights)
