"""Thousands of samples: a few hundred are placed together, all others by their distances to those."""

from __future__ import annotations

import numpy as np

from geodesics import SurfacePoints
from geodesics.points import joined, mixed
from gmds.mds.certificate import of_all_pairs
from gmds.mds.losses import Loss, as_loss
from gmds.mds.problem import Problem
from gmds.mds.prolongation import prolonged
from gmds.mds.solver import Solution, solve

MANY = 1000
"""Samples from which on this takes less time than all pairs at once (`benchmarks/cost/solver_cost.py`)."""
HEADS = 250
"""Samples that are placed together; chosen there: what the others are placed by, at two coordinates each."""
STEPS = 8
"""Of all samples, twice, first in haste: a bound; after it the stress of all pairs is where two steps of all pairs
took it, in the same time (benchmarks/results/solver_memory.md)."""


def pairs_asked(count: int) -> int | None:
    """The `pairs` of a problem of so many samples as `solve_many` looks at: of many, those of the first alone."""
    return HEADS if count > MANY else None


FIXED = 3  # distances to placed samples that fix another: from two there are two places


def pairs_suffice(problem: Problem, heads: int) -> bool:
    """Whether the pairs with the first `heads` samples fix all others; not so where chosen pairs pass them by.

    A sample with fewer than `FIXED` of them, and others, is not fixed.
    """
    ours, theirs = problem.first < heads, problem.second < heads
    known = np.bincount(problem.second[ours], minlength=len(problem))
    known = known + np.bincount(problem.first[theirs], minlength=len(problem))
    every = np.bincount(np.concatenate([problem.first, problem.second]), minlength=len(problem))
    return not bool(((known < min(FIXED, heads - 1)) & (known < every)).any())


def solve_many(
    problem: Problem,
    start: SurfacePoints,
    loss: Loss | None = None,
    *,
    heads: int = HEADS,
    max_iterations: int = 50,
    tolerance: float = 1e-3,
) -> Solution:
    """As `solve`, for thousands of samples in farthest-point order: in a tenth of the time, to about the same stress.

    The first are solved for alone, from their start. Each other sample goes to the vertex that best keeps its distances
    to those; then all of them are moved so that the distances to the first are kept. Memory is linear in the number of
    samples, but for pairs that the problem itself has. Where those with the first do not fix all others, as of pairs
    that were chosen, it is `solve`.

    Parameters
    ----------
    problem, start, loss, max_iterations, tolerance
        As of `solve`. The iterations are those of the first samples; all samples have twice `STEPS` at the most.
    heads : int
        How many are the first, at least 3 and at most all.

    Returns
    -------
    Solution
        Of all pairs of the problem; its certificate too, by what those with the first samples allow.

    See Also
    --------
    solve : All pairs at once.
    solve_multiresolution : From few samples to many in many steps.
    """
    heads, loss = min(max(3, heads), len(problem)), as_loss(loss)
    if not pairs_suffice(problem, heads):
        return solve(problem, start, loss, max_iterations=max_iterations, tolerance=tolerance)
    points = solve(problem.head(heads), start[:heads], loss, max_iterations=max_iterations, tolerance=tolerance).points
    anchored, table = problem.anchored(heads), problem.distance_table(heads)
    reached = np.asarray(np.isfinite(table[heads:]).any(axis=1))
    points = joined(points, mixed(reached, prolonged(table[heads:], problem.target_distance, points), start[heads:]))
    for asked in (10 * tolerance, tolerance):
        found = solve(anchored, points, loss, max_iterations=min(STEPS, max_iterations), tolerance=asked)
        points = found.points
    return of_all_pairs(problem, anchored, found, loss)
