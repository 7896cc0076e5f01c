"""Placing samples by their distances to samples that are placed already."""

from __future__ import annotations

import numpy as np

from geodesics import Distance, SurfacePoints
from geodesics.arrays import Floats
from geodesics.points import mixed
from geodesics.topology.components import vertex_components
from gmds.mds.problem import Placement

ROWS = 512
"""Samples that are looked at together: a bound of memory."""
GOALS = 5000
"""Vertices that they may be sent to: as many as shapes of this field have; of more, some all over. Set by hand."""


def prolonged(distances: Floats, target_distance: Distance, placed: SurfacePoints) -> SurfacePoints:
    """The vertices v where the sum over j of (distances[i, j] - d_Q(v, placed_j))^2 is least, one a row.

    `distances` (q, p) from q new source samples to the p placed ones; those that are not finite do not count. Of a
    surface with many vertices, `GOALS` are looked at.
    """
    mesh, field = target_distance.mesh, target_distance.field(placed)
    goals = np.flatnonzero(vertex_components(mesh) >= 0)
    if len(goals) > GOALS:
        goals = np.sort(np.random.default_rng(0).choice(goals, GOALS, replace=False))
    field = np.ascontiguousarray(field[:, goals])
    best = np.zeros(len(distances), dtype=np.int64)
    for start in range(0, len(distances), ROWS):
        rows = slice(start, start + ROWS)
        known = np.isfinite(distances[rows])
        best[rows] = costs(np.where(known, distances[rows], 0.0), known.astype(np.float64), field).argmin(axis=1)
    return SurfacePoints.at_vertices(mesh, goals[best])


def costs(distances: Floats, weights: Floats, field: Floats) -> Floats:
    """The sum over j of weights[i, j] (distances[i, j] - field[j, v])^2 for every v: (q, n).

    What is out of reach counts as three times the largest distance.
    """
    field = np.where(np.isfinite(field), field, 3 * distances.max())
    own = (weights * distances**2).sum(axis=1)[:, None]
    return own - 2 * (weights * distances) @ field + weights @ field**2


def relocated(placement: Placement, rounds: int = 3) -> Placement:
    """The placement with samples moved to the vertices that suit them best while the others stay.

    A sample wants to move when its own squared residuals fall by a twentieth at least. All who want move together;
    while that does not lower the sum of all squared residuals, only the half of them with more to gain. At most
    `rounds` times, as samples moved first draw others along.
    """
    for _ in range(rounds):
        moved = _relocated_once(placement)
        if moved is placement:
            break
        placement = moved
    return placement


def _relocated_once(placement: Placement) -> Placement:
    """One round of `relocated`; the placement itself when nobody moves."""
    problem, points, index = placement.problem, placement.points, np.arange(len(placement.problem))
    distances, weights = np.zeros((2, len(problem), len(problem)))
    for one, other in ((problem.first, problem.second), (problem.second, problem.first)):
        distances[one, other], weights[one, other] = problem.source_distances / problem.unit, problem.root_weights**2
    field = problem.target_distance.field(points)
    cost = costs(distances * problem.unit, weights / problem.unit**2, field)
    cost[:, vertex_components(points.mesh) < 0] = np.inf
    best, now = cost.argmin(axis=1), placement.shares
    gain = now - cost[index, best]
    chosen = np.argsort(-gain, kind="stable")[: int((gain > 0.05 * now).sum())]
    there, total = SurfacePoints.at_vertices(points.mesh, best), now.sum()
    while len(chosen):
        moved = problem.at(mixed(np.isin(index, chosen), there, points))
        if moved.shares.sum() < total:
            return moved
        chosen = chosen[: len(chosen) // 2]
    return placement
