"""Embedding one surface in another: linearise, step, walk, accept or shrink."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics import SurfacePoints
from geodesics.arguments import real_number, whole_number
from geodesics.arrays import Floats
from gmds.errors import SolverError
from gmds.mds.descent import Settler
from gmds.mds.field_pairs import FieldPairs
from gmds.mds.frozen_fields import remarch
from gmds.mds.losses import Loss, as_loss
from gmds.mds.problem import Problem
from gmds.mds.status import Status


@dataclass(frozen=True, eq=False)
class Solution:
    """Where the samples ended, and how it came about.

    Attributes
    ----------
    points : SurfacePoints
        The p points of the target.
    stress : float
        The loss of the residuals, without unit.
    residuals : float64 array of shape (r,)
        Of the pairs of the problem.
    status : Status
        Why the solver ended.
    certificate : float
        The linearised problem can lower the stress by no more than this share of it, the points staying in their faces,
        and in the faces around them in turn for points on edges and vertices; inf where the iteration limit came first,
        or all points lie in one place, where distances have no derivative and nothing parts them.
    certificate_radius : float
        The trust region of that problem, in mean distances a point.
    iterations : int
        Of both descents together.

    Examples
    --------
    >>> import geodesics, gmds
    >>> from gmds.shapes import quadruped
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> ours, theirs = (geodesics.BiharmonicDistance(mesh) for mesh in (source, target))
    >>> samples = geodesics.SurfacePoints.at_vertices(source, geodesics.farthest_point_sampling(ours, 10))
    >>> problem = gmds.Problem(ours, samples, theirs)
    >>> start = geodesics.SurfacePoints.closest(target, samples.positions)
    >>> solution = gmds.solve(problem, start)
    >>> solution.points.positions.shape, len(solution.residuals)
    ((10, 3), 45)
    """

    points: SurfacePoints
    stress: float
    residuals: Floats
    status: Status
    certificate: float
    certificate_radius: float
    iterations: int

    def __repr__(self) -> str:
        certificate = f"certificate {self.certificate:.2g}" if np.isfinite(self.certificate) else "no certificate"
        words = f"{len(self.points)} points, stress {self.stress:.4g}, {certificate}"
        return f"Solution({words}, {self.status.name} after {self.iterations})"

    def as_meta(self) -> dict[str, Any]:
        """What `Correspondence.meta` says of it: why the `solver` ended, and its `certificate`, None for inf."""
        return {"solver": self.status.name, "certificate": self.certificate if np.isfinite(self.certificate) else None}


def solve(
    problem: Problem,
    start: SurfacePoints | ArrayLike,
    loss: Loss | None = None,
    *,
    max_iterations: int = 50,
    tolerance: float = 1e-3,
    progress: Callable[[str, float], None] | None = None,
) -> Solution:
    """Lower the loss of the residuals (sec. 5) from `start`, points of the target.

    Each round linearises the distances at the points, asks the loss for a step within the trust region, walks the
    points straight across the faces, and keeps them there if the stress falls; else the region shrinks. When the
    linearised problem predicts less than `tolerance` times the stress, or no step helps, a second descent keeps every
    point in its face, in each of the faces in turn for points on edges and vertices, where the distances have kinks.
    The stress never rises. Fields of geodesic distances stay frozen through both descents and are then marched anew,
    until that brings nothing.

    Parameters
    ----------
    problem : Problem
        Which distances are to be kept, of p samples.
    start : SurfacePoints or array_like of int
        p points of the target, or vertices.
    loss : Loss, optional
        How residuals add up; least squares unless given.
    max_iterations : int
        Rounds, at the most.
    tolerance : float
        Share of the stress that is not worth a round.
    progress : callable, optional
        Called as `progress("embedding", fraction)`.

    Returns
    -------
    Solution
        A poor result is no error: its `status` and `certificate` say what it is worth.

    Raises
    ------
    SolverError
        When the stress is not finite at the start (E403).
    ValueError
        When `start` does not fit the problem, for an iteration limit or a tolerance below 0.

    See Also
    --------
    solve_multiresolution : From few samples to many.
    match : Finds a start as well.

    Examples
    --------
    >>> import geodesics, gmds
    >>> from gmds.shapes import quadruped
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> ours, theirs = (geodesics.BiharmonicDistance(mesh) for mesh in (source, target))
    >>> samples = geodesics.SurfacePoints.at_vertices(source, geodesics.farthest_point_sampling(ours, 10))
    >>> problem = gmds.Problem(ours, samples, theirs)
    >>> start = geodesics.SurfacePoints.closest(target, samples.positions)
    >>> solution = gmds.solve(problem, start, gmds.Huber())
    >>> bool(solution.stress < gmds.Huber().value(problem.at(start).residuals))
    True
    """
    if not isinstance(problem, Problem):
        raise TypeError(f"a problem is expected, not {type(problem).__name__}; make one with gmds.Problem")
    max_iterations = whole_number(max_iterations, "max_iterations", 0)
    tolerance, loss, here = real_number(tolerance, "tolerance", 0.0), as_loss(loss), problem.at(start)
    stress = loss.value(here.residuals)
    if not np.isfinite(stress):
        raise SolverError(f"the stress at the start is {stress}: a distance is not a number")
    if stress > 0 and len(here.lengths) and not here.lengths.any():  # where distances have no derivative
        return Solution(here.points, stress, here.residuals, Status.STALLED, np.inf, 0.0, 0)

    def report(iteration: int) -> None:
        if progress is not None:
            progress("embedding", iteration / max_iterations)

    settle = Settler(loss, tolerance, report)
    if isinstance(here.pairs, FieldPairs):
        state = remarch(here, settle, max_iterations)
    else:
        state = settle(here, max_iterations)
    certificate = state.predicted / state.stress if state.stress > 0 else 0.0
    return Solution(
        state.here.points, state.stress, state.here.residuals, state.status, certificate, state.radius, state.iteration
    )
