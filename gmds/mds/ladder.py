"""Losses that are sharp at their minimum, reached through smooth ones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics import SurfacePoints
from geodesics.arrays import Floats
from geodesics.distance import as_points
from gmds.mds.certificate import certified
from gmds.mds.losses import LeastSquares, Loss, Minimax, Power, SmoothLoss, as_loss
from gmds.mds.many_samples import MANY, solve_many
from gmds.mds.problem import Problem
from gmds.mds.solver import Solution, solve

EXPONENTS = (4.0, 8.0, 16.0, 32.0)
"""On the way from least squares to the maximum: each doubles, so that no residual gains much on another at once."""
# Of least squares below a maximum, as shares of it: where the wall begins, and from where steps heed it; and how stiff
# it is. From 0.8, not from the wall itself, or many a first step runs into it (benchmarks/results/notes.md, "Minimax").
WALL, HEEDED, STIFFNESS = 0.98, 0.8, 1e3
MORE = 0.01  # share by which the maximum may rise for the sake of the rest: a bound, what a certificate leaves open
STEPS = 10  # of each exponent, at the most: a bound, the next one goes on from there


def solve_by_ladder(
    problem: Problem,
    start: SurfacePoints | ArrayLike,
    loss: Loss | None = None,
    *,
    max_iterations: int = 50,
    tolerance: float = 1e-3,
) -> Solution:
    r"""As `solve`, but a maximum, or a high power, is approached through lower powers of the residuals.

    So are many samples through few (`solve_many`).

    .. math:: p = 2, 4, 8, 16, 32, \infty

    Far from its minimum the maximum is decided by a single pair, and the linear program moves the few samples that
    matter to it until the next pair is as bad; least squares moves all of them, and each power attends to fewer pairs.
    Many maps have the least maximum, as most pairs have no say in it. Of these the one with about the least squares is
    returned:

    .. math:: \min_\rho \sum r^2 \quad \text{where} \quad \max |r| \le m

    Parameters
    ----------
    problem, start, max_iterations, tolerance
        As of `solve`; the iterations are those of the first and of the last loss.
    loss : Loss, optional
        `Minimax`, or a `Power` above 2, goes up the ladder; any other is left to `solve`.

    Returns
    -------
    Solution
        Of the loss itself, with its certificate, also where the iteration limit came first.

    See Also
    --------
    solve : One loss alone.

    References
    ----------
    Sec. 5 of Aflalo, Kimmel, Raviv (2013), for the maximum; Lp norms on the way to it: Bronstein, Bronstein, Kimmel:
    Generalized multidimensional scaling (2006).

    Examples
    --------
    >>> import geodesics, gmds
    >>> from gmds.shapes import quadruped
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> ours, theirs = (geodesics.BiharmonicDistance(mesh) for mesh in (source, target))
    >>> samples = geodesics.SurfacePoints.at_vertices(source, geodesics.farthest_point_sampling(ours, 10))
    >>> problem = gmds.Problem(ours, samples, theirs)
    >>> start = geodesics.SurfacePoints.closest(target, samples.positions)
    >>> most = gmds.solve_by_ladder(problem, start, gmds.Minimax(), max_iterations=10)
    >>> bool(most.stress == abs(most.residuals).max())
    True
    """
    loss, start = as_loss(loss), as_points(problem.target_distance.mesh, start)
    rungs = rungs_below(loss)
    smooth = solve_many if len(problem) > MANY else solve
    if rungs:
        below = smooth(problem, start, LeastSquares(), max_iterations=max_iterations, tolerance=tolerance)
        start = below.points
        for exponent in rungs:
            start = solve(problem, start, Power(exponent), max_iterations=STEPS, tolerance=tolerance).points
    last = solve if rungs else smooth
    found = last(problem, start, loss, max_iterations=max_iterations, tolerance=tolerance)
    if not isinstance(loss, Minimax):
        return certified(problem, found, loss)
    calm = solve(problem, found.points, _Below(found.stress), max_iterations=max_iterations, tolerance=tolerance)
    again = solve(problem, calm.points, loss, max_iterations=max_iterations, tolerance=tolerance)
    return certified(problem, again if again.stress <= (1 + MORE) * found.stress else found, loss)


@dataclass(frozen=True)
class _Below(SmoothLoss):
    """The mean of r^2 + `STIFFNESS` max(|r| - `WALL` most, 0)^2: least squares, and a wall near the maximum."""

    most: float

    def rho(self, residuals: Floats) -> Floats:
        """As above."""
        return residuals**2 + STIFFNESS * self._above(residuals) ** 2

    def slope(self, residuals: Floats) -> Floats:
        """2 r, and twice the stiffness times what is above the wall."""
        return 2 * (residuals + STIFFNESS * np.sign(residuals) * self._above(residuals))

    def curvature(self, residuals: Floats) -> Floats:
        """2, and twice the stiffness where a step may meet the wall: a bound of the second derivative."""
        return np.asarray(2 + 2 * STIFFNESS * (np.abs(residuals) > HEEDED * self.most), dtype=np.float64)

    def _above(self, residuals: Floats) -> Floats:
        return np.maximum(np.abs(residuals) - WALL * self.most, 0.0)


def rungs_below(loss: Loss) -> list[float]:
    """The exponents on the way from least squares to a loss; none where there is no way to go."""
    most = loss.exponent if isinstance(loss, Power) else float("inf") if isinstance(loss, Minimax) else 0.0
    return [exponent for exponent in EXPONENTS if exponent < most]
