"""A pair of animals, and a map between them whose front legs are swapped."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geodesics import SurfacePoints
from gmds import Correspondence
from gmds.shapes import quadruped, truth


class SwappedPair(NamedTuple):
    """The wrong map, the true points, and the vertex at each front paw with its true partner."""

    wrong: Correspondence
    true: SurfacePoints
    paws: list[tuple[int, int]]


def swapped_pair(n_vertices: int = 600) -> SwappedPair:
    """As in `gmds demo`, with fewer vertices; the front legs of the source go to the wrong side each."""
    source, target = quadruped(n_vertices=n_vertices), quadruped("walk", head_scale=2.0, n_vertices=n_vertices, seed=1)
    true, flipped = truth(source, target), truth(source, target, mirrored=True)
    x, y, z = source.vertices.T
    legs = (z < 0.6) & (x > 0.2)
    face = np.where(legs, flipped.face, true.face)
    weights = np.where(legs[:, None], flipped.barycentric, true.barycentric)
    wrong = Correspondence.from_points(source, SurfacePoints(target, face, weights))
    nearest = true.nearest_vertices()
    paws = [np.flatnonzero(legs & (side * y > 0)) for side in (1, -1)]
    tips = [int(rows[x[rows].argmax()]) for rows in paws]
    return SwappedPair(wrong, true, [(tip, int(nearest[tip])) for tip in tips])
