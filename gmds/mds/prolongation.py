"""Placing samples by their distances to samples that are placed already."""

from __future__ import annotations

import numpy as np

from geodesics import Distance, SurfacePoints
from geodesics.arrays import Floats
from geodesics.points import mixed
from geodesics.topology.components import vertex_components
from gmds.mds.problem import Placement


def prolonged(distances: Floats, target_distance: Distance, placed: SurfacePoints) -> SurfacePoints:
    """The vertices v where the sum over j of (distances[i, j] - d_Q(v, placed_j))^2 is least, one a row.

    `distances` (q, p) from q new source samples to the p placed ones; those that are not finite do not count.
    """
    known = np.isfinite(distances)
    cost = costs(np.where(known, distances, 0.0), known.astype(np.float64), target_distance, placed)
    return SurfacePoints.at_vertices(target_distance.mesh, cost.argmin(axis=1))


def costs(distances: Floats, weights: Floats, target_distance: Distance, placed: SurfacePoints) -> Floats:
    """The sum over j of weights[i, j] (distances[i, j] - d_Q(v, placed_j))^2 for every vertex v: (q, n).

    Vertices on no face cost infinitely much; what is out of reach counts as three times the largest distance.
    """
    field = target_distance.field(placed)
    field = np.where(np.isfinite(field), field, 3 * distances.max())
    cost = (weights * distances**2).sum(axis=1)[:, None] - 2 * (weights * distances) @ field + weights @ field**2
    cost[:, vertex_components(target_distance.mesh) < 0] = np.inf
    return cost


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
    cost = costs(distances * problem.unit, weights / problem.unit**2, problem.target_distance, points)
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
