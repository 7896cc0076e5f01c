"""Placing samples by their distances to samples that are placed already."""

from __future__ import annotations

import numpy as np

from geodesics import Distance, SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.points import mixed
from geodesics.topology.components import vertex_components
from gmds.mds.pair_distances import distances_to
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
    goals, field = fields_at_goals(target_distance, placed)
    best = np.zeros(len(distances), dtype=np.int64)
    for rows in _rows(len(distances)):
        known = np.isfinite(distances[rows])
        best[rows] = costs(np.where(known, distances[rows], 0.0), known.astype(np.float64), field).argmin(axis=1)
    return SurfacePoints.at_vertices(target_distance.mesh, goals[best])


def fields_at_goals(distance: Distance, placed: SurfacePoints) -> tuple[Integers, Floats]:
    """Vertices that samples may be sent to (g,), and the distances there from placed ones (p, g)."""
    goals = np.flatnonzero(vertex_components(distance.mesh) >= 0)
    if len(goals) > GOALS:
        goals = np.sort(np.random.default_rng(0).choice(goals, GOALS, replace=False))
    return goals, distances_to(distance, placed, goals)


def _rows(count: int) -> list[slice]:
    """Of so many samples, those that are looked at together."""
    return [slice(start, start + ROWS) for start in range(0, count, ROWS)]


def costs(distances: Floats, weights: Floats, field: Floats, farthest: float | None = None) -> Floats:
    """The sum over j of weights[i, j] (distances[i, j] - field[j, v])^2 for every v: (q, n).

    What is out of reach counts as three times the largest distance, of these unless `farthest` says so.
    """
    field = np.where(np.isfinite(field), field, 3 * (distances.max() if farthest is None else farthest))
    own = (weights * distances**2).sum(axis=1)[:, None]
    return own - 2 * (weights * distances) @ field + weights @ field**2


def relocated(placement: Placement, rounds: int = 3, *, heads: int | None = None) -> Placement:
    """The placement with samples moved to the vertices that suit them best while the others stay.

    A sample wants to move when its own squared residuals fall by a twentieth at least; of them those with the first
    `heads` samples count, with all unless given. All who want move together; while that does not lower the sum of all
    squared residuals, only the half of them with more to gain. At most `rounds` times, as samples moved first draw
    others along. Of a surface with many vertices, `GOALS` are looked at.
    """
    tables = placement.problem.distance_table(heads), placement.problem.weight_table(heads)
    for _ in range(rounds):
        moved = _relocated_once(placement, *tables)
        if moved is placement:
            break
        placement = moved
    return placement


def _relocated_once(placement: Placement, distances: Floats, weights: Floats) -> Placement:
    """One round of `relocated` by distances and weights (p, h) to the first; the placement itself if nobody moves."""
    problem, points = placement.problem, placement.points
    goals, field = fields_at_goals(problem.target_distance, points[: distances.shape[1]])
    known, now = np.where(weights > 0, distances, 0.0), _shares(placement, distances.shape[1])
    best, least, farthest = np.zeros(len(points), dtype=np.int64), np.zeros(len(points)), float(known.max())
    for rows in _rows(len(points)):
        cost = costs(known[rows], weights[rows] / problem.unit**2, field, farthest)
        best[rows], least[rows] = goals[cost.argmin(axis=1)], cost.min(axis=1)
    gain = now - least
    chosen = np.argsort(-gain, kind="stable")[: int((gain > 0.05 * now).sum())]
    there, total = SurfacePoints.at_vertices(points.mesh, best), placement.shares.sum()
    while len(chosen):
        moved = problem.at(mixed(np.isin(np.arange(len(points)), chosen), there, points))
        if moved.shares.sum() < total:
            return moved
        chosen = chosen[: len(chosen) // 2]
    return placement


def _shares(placement: Placement, heads: int) -> Floats:
    """The sum of the squared residuals of each sample with the first `heads`, (p,)."""
    first, second, square = placement.problem.first, placement.problem.second, placement.residuals**2
    ours = np.bincount(first, np.where(second < heads, square, 0.0), len(placement.problem))
    theirs = np.bincount(second, np.where(first < heads, square, 0.0), len(placement.problem))
    return np.asarray(ours + theirs, dtype=np.float64)
