"""The similarity nearest to a map: rotation, size and shift by which points come closest to where they are sent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geodesics.arrays import Floats
from gmds._kernels.rotations import nearest_rotations


class NearestSimilarity(NamedTuple):
    """The map y = size R (x - here) + there, with a `rotation` R (3, 3) and `here`, `there` (3,)."""

    rotation: Floats
    size: float
    here: Floats
    there: Floats

    def moved(self, points: Floats) -> Floats:
        """Where it sends points (p, 3)."""
        return np.asarray(self.size * (points - self.here) @ self.rotation.T + self.there, dtype=np.float64)


def nearest_similarity(points: Floats, goals: Floats, shares: Floats) -> NearestSimilarity:
    """The similarity, not mirrored, that brings points (n, 3) closest to goals (n, 3), weighted by shares (n,) of 1.

    The least sum of squares has the weighted means on each other, the nearest rotation to the products of what is left
    (Horn 1987), and the size of Umeyama (1991). That of points in one place is 0.
    """
    here, there = shares @ points, shares @ goals
    x, y = points - here, goals - there
    rotations, sums = nearest_rotations(np.ascontiguousarray(((shares[:, None] * x).T @ y)[None]))
    spread = max(float(shares @ (x**2).sum(axis=1)), np.finfo(float).tiny)
    return NearestSimilarity(rotations[0], float(sums[0] / spread), here, there)
