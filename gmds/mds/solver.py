"""Embedding one surface in another: linearise, step, walk, accept or shrink."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Floats
from gmds.errors import SolverError
from gmds.mds.descent import Settler
from gmds.mds.frozen_fields import remarch
from gmds.mds.losses import LeastSquares, Loss
from gmds.mds.pair_distances import FieldPairs
from gmds.mds.problem import Problem
from gmds.mds.status import Status


@dataclass(frozen=True, eq=False)
class Solution:
    """Where the samples ended: target points (p,), stress = loss of the residuals (r,), and how it came about.

    `certificate`: the linearised problem can lower the stress by no more than this share of it, within a trust region
    of `certificate_radius` mean distances a point, the points staying in their faces, and in the faces around them in
    turn for points on edges and vertices. It is inf where the iteration limit came first.
    """

    points: SurfacePoints
    stress: float
    residuals: Floats
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
    """Lower the loss of the residuals (sec. 5) from `start` (p,), points of the target; least squares unless said.

    Each of at most `max_iterations` rounds linearises the distances at the points, asks the loss for a step within
    the trust region, walks the points straight across the faces, and keeps them there if the stress falls; else the
    region shrinks. When the linearised problem predicts less than `tolerance` times the stress, or no step helps, a
    second descent keeps every point in its face, in each of the faces in turn for points on edges and vertices, where
    the distances have kinks. The stress never rises. Fields of geodesic distances stay frozen through both descents
    and are then marched anew, until that brings nothing. `progress` is called with a stage and a fraction.
    Raises `SolverError` (E403) when the stress is not finite at the start, `ValueError` when `start` does not fit.
    """
    loss = LeastSquares() if loss is None else loss
    here = problem.at(start)
    stress = loss.value(here.residuals)
    if not np.isfinite(stress):
        raise SolverError(f"the stress at the start is {stress}: a distance is not a number")

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
