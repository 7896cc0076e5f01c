"""Embedding one surface in another: linearise, step, walk, accept or shrink."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geodesics import SurfacePoints
from geodesics.tracing import walk
from gmds.losses import LeastSquares, Loss
from gmds.problem import Placement, Problem
from gmds.status import SolverError, Status

Array = NDArray[np.float64]
SHORTEST, LONGEST = 1e-6, 0.5
"""Bounds of the trust region, in mean distances."""


@dataclass(frozen=True, eq=False)
class Solution:
    """Where the samples ended: target points (p,), stress = loss of the residuals (r,), and how it came about.

    `certificate` is the relative amount by which the linearised problem could still lower the stress within a trust
    region of `certificate_radius` mean distances.
    """

    points: SurfacePoints
    stress: float
    residuals: Array
    status: Status
    certificate: float
    certificate_radius: float
    iterations: int


def solve(
    problem: Problem,
    start: SurfacePoints,
    loss: Loss | None = None,
    *,
    max_iterations: int = 50,
    tolerance: float = 1e-3,
    progress: Callable[[str, float], None] | None = None,
) -> Solution:
    """Lower the loss of the residuals from `start` (p,); least squares unless said.

    Each of at most `max_iterations` rounds linearises the distances at the points, asks the loss for a step within
    the trust region, walks the points straight across the faces, and keeps the step if the stress falls by at least
    a tenth of what was predicted; else the region shrinks. Ends when the prediction falls below `tolerance` times the
    stress. The stress never rises. Raises `SolverError` (E403) when it is not finite at the start.
    """
    loss = LeastSquares() if loss is None else loss
    here = problem.at(start)
    stress = loss.value(here.residuals)
    if not np.isfinite(stress):
        raise SolverError(f"the stress at the start is {stress}: a distance is not a number")
    negligible = loss.value(np.full_like(here.residuals, 1e-10))
    radius = float(np.clip(2 * np.sqrt(np.mean(here.residuals**2)), SHORTEST, LONGEST))
    status, iteration, predicted = Status.ITERATION_LIMIT, 0, np.inf
    for iteration in range(1, max_iterations + 1):
        step = loss.step(here.jacobian, here.residuals, radius)
        predicted = stress - loss.value(here.residuals + here.jacobian.apply(step))
        if stress <= negligible or not predicted > tolerance * stress:
            status = Status.CONVERGED
            break
        there = problem.at(walk(here.points, here.jacobian.displacement(step)))
        gain = stress - loss.value(there.residuals)
        agreement = gain / predicted
        if not agreement > 0.25:
            there = _without_setbacks(here, there)
            gain = stress - loss.value(there.residuals)
            agreement = min(gain / predicted, 0.5)
        radius = _resized(radius, agreement)
        if gain > 0:
            here, stress = there, stress - gain
        elif radius <= SHORTEST:
            status = Status.STALLED
            break
        if progress is not None:
            progress("embedding", iteration / max_iterations)
    certificate = float(max(predicted, 0.0) / stress) if stress > 0 else 0.0
    return Solution(here.points, stress, here.residuals, status, certificate, radius, iteration)


def _without_setbacks(here: Placement, there: Placement) -> Placement:
    """`there`, with the points back in place whose own squared residuals grew."""
    kept = _share(there) < _share(here)
    face = np.where(kept, there.points.face, here.points.face)
    barycentric = np.where(kept[:, None], there.points.barycentric, here.points.barycentric)
    return here.problem.at(SurfacePoints(here.points.mesh, face, barycentric))


def _share(placement: Placement) -> Array:
    """The sum of the squared residuals of each point, (p,)."""
    problem, square = placement.problem, placement.residuals**2
    count = len(problem)
    return np.bincount(problem.first, square, count) + np.bincount(problem.second, square, count)


def _resized(radius: float, agreement: float) -> float:
    """Twice the radius where the linearisation foretold the gain well, a half or a quarter where it did not."""
    factor = 2.0 if agreement > 0.75 else 1.0 if agreement > 0.25 else 0.5 if agreement > 0 else 0.25
    return float(np.clip(factor * radius, SHORTEST, LONGEST))
