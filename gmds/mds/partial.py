"""Partial generalised multidimensional scaling: which samples have a counterpart is unknown, too."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Distance, SurfacePoints
from geodesics.arguments import whole_number
from geodesics.arrays import Floats
from geodesics.distance import as_points
from geodesics.errors import BadArgument
from gmds.mds.losses import LeastSquares
from gmds.mds.problem import Problem
from gmds.mds.solver import Solution, solve

STEPS = 200  # of projected gradients for the weights, at the most: a bound
LEAST_WEIGHT = 1e-4  # of a sample in the placing: a bound, so that what is left out is still carried along
HALVINGS = 60  # of an interval, until it is as short as rounding: a bound


@dataclass(frozen=True, eq=False)
class PartialSolution:
    """Samples placed, and how much each has a part in what the surfaces have in common.

    Attributes
    ----------
    solution : Solution
        The samples of the last round, placed with the weights before; its stress is of pairs that weigh w_i w_j.
    weights : float64 array of shape (p,)
        From 0, without counterpart, to 1; their mean is the share that was asked for.
    stresses : tuple of float
        The objective at the start and after each round; it never rises.

    Examples
    --------
    >>> import geodesics, gmds
    >>> from gmds.shapes import quadruped
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> ours, theirs = (geodesics.BiharmonicDistance(mesh) for mesh in (source, target))
    >>> samples = geodesics.SurfacePoints.at_vertices(source, geodesics.farthest_point_sampling(ours, 10))
    >>> start = geodesics.SurfacePoints.closest(target, samples.positions)
    >>> gmds.solve_partial(ours, samples, theirs, start, share=0.8, rounds=1).weights.shape
    (10,)
    """

    solution: Solution
    weights: Floats
    stresses: tuple[float, ...]

    def __repr__(self) -> str:
        counted = f"{len(self.weights)} points, {int((self.weights > 0.5).sum())} with a weight above 1/2"
        return f"PartialSolution({counted}, stress {self.stresses[-1]:.4g} after {len(self.stresses) - 1})"


def solve_partial(
    source_distance: Distance,
    source_points: SurfacePoints | ArrayLike,
    target_distance: Distance,
    start: SurfacePoints | ArrayLike,
    *,
    share: float = 0.7,
    rounds: int = 5,
    max_iterations: int = 30,
    progress: Callable[[str, float], None] | None = None,
) -> PartialSolution:
    r"""Place the part of some samples that has counterparts on the target, beside sec. 5.

    .. math:: \min_{\rho, w} \sum_{i < j} w_i w_j
        \left(\frac{d_S(s_i, s_j) - d_Q(\rho_i, \rho_j)}{\bar d_S}\right)^2, \qquad
        0 \le w_i \le 1, \quad \frac1p \sum_i w_i = \text{share}

    in turn by the places :math:`\rho`, with weights that stay, and by the weights, at places that stay: membership in a
    part is fuzzy. Neither raises the sum. Samples that cannot reach each other have no say in it.

    Parameters
    ----------
    source_distance, target_distance : Distance
        Distances of the two surfaces.
    source_points : SurfacePoints or array_like of int
        The p samples of the source, or vertices, each of as much area as any other.
    start : SurfacePoints or array_like of int
        Where they are to begin, on the target.
    share : float
        How much of the samples has a counterpart, above 0 and at most 1.
    rounds : int
        Of places and weights, at the most; they end where the sum falls by less than a thousandth.
    max_iterations : int
        Of `solve`, in each round.
    progress : callable, optional
        Called as `progress("embedding", fraction)`.

    Returns
    -------
    PartialSolution
        The places, the weights, and how the sum fell.

    Raises
    ------
    ValueError
        For another share or number (E604), or as `Problem` does.
    SolverError
        When a distance is not a number (E403).

    References
    ----------
    A. M. Bronstein, M. M. Bronstein, A. M. Bruckstein, R. Kimmel: Partial similarity of objects, or how to compare a
    centaur to a horse (2009): fuzzy parts, here of samples, for one share on their Pareto front.

    See Also
    --------
    solve : All samples count alike.
    match : Looks for parts with `parts=`.

    Examples
    --------
    >>> import geodesics, gmds
    >>> from gmds.shapes import quadruped
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> ours, theirs = (geodesics.BiharmonicDistance(mesh) for mesh in (source, target))
    >>> samples = geodesics.SurfacePoints.at_vertices(source, geodesics.farthest_point_sampling(ours, 10))
    >>> start = geodesics.SurfacePoints.closest(target, samples.positions)
    >>> found = gmds.solve_partial(ours, samples, theirs, start, share=0.8, rounds=2)
    >>> bool(found.stresses[-1] <= found.stresses[0]), round(float(found.weights.mean()), 6)
    (True, 0.8)
    """
    if isinstance(share, bool) or not isinstance(share, Real) or not 0 < share <= 1:
        raise BadArgument(f"share must be a number above 0 and at most 1, not {share!r:.40}")
    rounds, max_iterations = whole_number(rounds, "rounds", 1), whole_number(max_iterations, "max_iterations", 0)
    even = Problem(source_distance, source_points, target_distance)
    start = as_points(even.target_distance.mesh, start)
    weights = np.full(len(even), float(share))
    misfit = misfits(even, start)
    stresses, points = [float(weights @ misfit @ weights / 2)], start
    for number in range(rounds):
        held = np.maximum(weights, LEAST_WEIGHT)
        weighed = Problem(source_distance, source_points, target_distance, weights=held)
        found = solve(weighed, points, LeastSquares(), max_iterations=max_iterations)
        moved = misfits(even, found.points)
        if weights @ moved @ weights <= weights @ misfit @ weights:  # but for the least weight it always is
            points, misfit = found.points, moved
        else:
            found = solve(weighed, points, LeastSquares(), max_iterations=0)  # as they lay
        weights = least_weights(misfit, weights, share)
        stresses.append(float(weights @ misfit @ weights / 2))
        if progress is not None:
            progress("embedding", (number + 1) / rounds)
        if stresses[-1] > (1 - 1e-3) * stresses[-2]:
            break
    return PartialSolution(found, weights, tuple(stresses))


def misfits(problem: Problem, points: SurfacePoints) -> Floats:
    """Squared residuals (p, p) of all pairs, which weigh alike, with the samples at `points`."""
    square = problem.at(points).residuals ** 2 / np.maximum(problem.root_weights, np.finfo(float).tiny) ** 2
    table = np.zeros((len(problem), len(problem)))
    table[problem.first, problem.second] = table[problem.second, problem.first] = square
    return table


def least_weights(misfit: Floats, weights: Floats, share: float) -> Floats:
    """Weights (p,) in [0, 1] of mean `share` for which w R w is no larger than before, R (p, p): projected gradients.

    The step is the reciprocal of a bound of the largest eigenvalue of R, so that every step lowers the sum.
    """
    largest = max(float(misfit.sum(axis=1).max()), np.finfo(float).tiny)
    for _ in range(STEPS):
        moved = on_simplex(weights - misfit @ weights / largest, share)
        if np.abs(moved - weights).max() < 1e-6:
            break
        weights = moved
    return weights


def on_simplex(values: Floats, share: float) -> Floats:
    """The point of {0 <= w <= 1, mean w = share} nearest to `values` (p,): shifted, then cut off, by bisection."""
    low, high = float(values.min()) - 1.0, float(values.max())
    for _ in range(HALVINGS):
        shift = (low + high) / 2
        if np.clip(values - shift, 0.0, 1.0).mean() > share:
            low = shift
        else:
            high = shift
    return np.asarray(np.clip(values - (low + high) / 2, 0.0, 1.0), dtype=np.float64)
