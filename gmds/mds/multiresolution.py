"""From few samples to many."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from geodesics import SurfacePoints
from geodesics.arguments import real_number
from geodesics.distance import as_points
from geodesics.errors import BadArgument
from geodesics.points import joined
from gmds.mds.certificate import of_all_pairs
from gmds.mds.losses import Loss, as_loss
from gmds.mds.many_samples import HEADS, MANY, pairs_suffice
from gmds.mds.problem import Problem
from gmds.mds.prolongation import prolonged, relocated
from gmds.mds.solver import Solution, solve


def solve_multiresolution(
    problem: Problem,
    start: SurfacePoints | ArrayLike,
    loss: Loss | None = None,
    *,
    growth: float = 2.0,
    max_iterations: int = 50,
    tolerance: float = 1e-3,
    progress: Callable[[str, float], None] | None = None,
) -> Solution:
    """Solve for the first samples, given as `start`, then for `growth` times as many, until all are placed (sec. 5).

    The samples of the problem should come in farthest-point order, so that the first k cover the surface. Between
    two levels each new sample goes to the vertex that best keeps its distances to the placed ones, and samples that
    would fare better elsewhere on the target are moved there. Above 1,000 samples pairs with the first 250 are looked
    at alone, as `match` does, so that memory is linear in the number of samples (`pairs=250` of `Problem` makes no
    others to begin with).

    Parameters
    ----------
    problem : Problem
        Which distances are to be kept, of p samples.
    start : SurfacePoints or array_like of int
        Points of the target, or vertices, for the first k samples, k from 2 to p.
    loss : Loss, optional
        How residuals add up; least squares unless given.
    growth : float
        Ratio of the numbers of samples of two levels, above 1.
    max_iterations, tolerance
        As of `solve`, at each level.
    progress : callable, optional
        Called as `progress("embedding", fraction)` after each level.

    Returns
    -------
    Solution
        Of all samples, and of all pairs of the problem.

    Raises
    ------
    ValueError
        When `start` is too short or too long, or `growth` is not above 1.
    SolverError
        As of `solve` (E403).

    See Also
    --------
    solve : One level.

    References
    ----------
    Bronstein, Bronstein, Kimmel: Efficient computation of isometry-invariant distances between surfaces (2006).

    Examples
    --------
    >>> import geodesics, gmds
    >>> from gmds.shapes import quadruped
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> ours, theirs = (geodesics.BiharmonicDistance(mesh) for mesh in (source, target))
    >>> samples = geodesics.SurfacePoints.at_vertices(source, geodesics.farthest_point_sampling(ours, 10))
    >>> problem = gmds.Problem(ours, samples, theirs)
    >>> start = geodesics.SurfacePoints.closest(target, samples.positions)
    >>> solution = gmds.solve_multiresolution(problem, start)
    >>> len(solution.points)
    10
    """
    start = as_points(problem.target_distance.mesh, start)
    count = len(start)
    if not real_number(growth, "growth") > 1:
        raise BadArgument(f"growth, of the samples from one level to the next, must be above 1, not {growth}")
    if not 2 <= count <= len(problem):
        raise BadArgument(f"start places {count} of {len(problem)} samples: it must be those of the first 2 or more")
    levels = [count]
    while levels[-1] < len(problem):
        levels.append(min(len(problem), int(np.ceil(growth * levels[-1]))))
    loss, points = as_loss(loss), start
    for level, size in enumerate(levels):
        part = problem.head(size)
        heads = HEADS if size > MANY and pairs_suffice(part, HEADS) else None
        asked = part if heads is None else part.anchored(heads)
        if size > len(points):
            known = part.distance_table(min(len(points), heads or size))[len(points) :]
            new = prolonged(known, problem.target_distance, points[: known.shape[1]])
            points = joined(points, new)
        if size < len(problem) and not len(asked.first):
            continue  # none of so few knows of another
        points = relocated(asked.at(points), heads=heads).points
        solution = solve(asked, points, loss, max_iterations=max_iterations, tolerance=tolerance)
        points = solution.points
        if progress is not None:
            progress("embedding", (level + 1) / len(levels))
    return solution if heads is None else of_all_pairs(problem, asked, solution, loss)
