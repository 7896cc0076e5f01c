"""One descent: linearise, step, walk, accept or shrink, until nothing is left to gain."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from geodesics.arrays import Floats
from geodesics.points import mixed
from geodesics.tracing import turned_over, walk
from gmds.mds.jacobian import Jacobian
from gmds.mds.losses import Loss
from gmds.mds.problem import Placement
from gmds.mds.status import Status

# Set by hand, in mean distances; certificates and the distance to known minima are what the tests of solvers check.
SHORTEST, LONGEST = 1e-6, 0.5
"""Bounds of the trust region."""
WALLED = 0.02
"""First trust region of a walled descent: the size of faces, beyond which walls stop every point."""
FREE = 0.005
"""A free descent ends when its trust region is no larger: smaller than most faces."""
CERTIFIED = 0.01
"""The smallest trust region in which a walled descent says that nothing is left to gain."""
SIDES = 6
"""How many times in a row points on edges are turned over before nothing is left to gain."""


@dataclass(frozen=True, eq=False)
class Descent:
    """Where a descent is: the placement, its stress, the trust region, and by how much the linearised problem
    last predicted the stress to fall."""

    here: Placement
    stress: float
    radius: float
    iteration: int = 0
    predicted: float = np.inf
    status: Status = Status.ITERATION_LIMIT


def descend(
    state: Descent,
    loss: Loss,
    *,
    walled: bool,
    tolerance: float,
    max_iterations: int,
    report: Callable[[int], None],
) -> Descent:
    """Lower the stress until the linearised problem predicts less than `tolerance` times the stress.

    Free: points walk across faces. Walled: each step keeps every point in its face, where the linearisation is good,
    and points that end on an edge are turned over to the other face before the next.
    """
    here, stress, radius = state.here, state.stress, state.radius
    negligible = loss.value(np.full_like(here.residuals, 1e-10))
    quiet: list[float] = []
    jacobian: Jacobian | None = None  # of `here`; let go before the next is made
    for iteration in range(state.iteration + 1, max_iterations + 1):
        if jacobian is None:
            jacobian = here.walled_jacobian if walled else here.jacobian
        if stress <= negligible:
            return Descent(here, stress, radius, iteration, 0.0, Status.CONVERGED)
        step, predicted = _predicted(here, stress, jacobian, loss, radius)
        if not np.isfinite(predicted):
            return Descent(here, stress, radius, iteration, np.inf, Status.STALLED)
        if predicted <= tolerance * stress:
            wide = max(radius, CERTIFIED) if walled else radius
            quiet.append(max(predicted, _predicted(here, stress, jacobian, loss, wide)[1] if wide > radius else 0.0))
            other, turned = turned_over(here.points)
            if not walled or not turned.any() or len(quiet) >= SIDES:
                flat = max(quiet) <= 10 * tolerance * stress
                return Descent(here, stress, wide, iteration, max(quiet), Status.CONVERGED if flat else Status.STALLED)
            here, jacobian = here.problem.at(other), None
            continue
        quiet = []
        there, ratio = _tried(here, stress, jacobian.displacement(step), predicted, loss, walled)
        radius = _resized(radius, ratio)
        if ratio > 0:
            here, stress, jacobian = there, loss.value(there.residuals), None
        if radius <= (SHORTEST if walled else FREE):
            return Descent(here, stress, radius, iteration, predicted, Status.STALLED)
        report(iteration)
    return Descent(here, stress, radius, max_iterations, np.inf, Status.ITERATION_LIMIT)


def remaining(here: Placement, loss: Loss) -> float:
    """By how much the problem linearised here lowers the stress, within the region that `CERTIFIED` says.

    Points stay in their faces, and in the faces around them in turn where they lie on edges, as in a walled descent.
    """
    most = 0.0
    for _ in range(SIDES):
        stress = loss.value(here.residuals)
        most = max(most, _predicted(here, stress, here.walled_jacobian, loss, CERTIFIED)[1])
        other, turned = turned_over(here.points)
        if not turned.any():
            break
        here = here.problem.at(other)
    return most


def _predicted(here: Placement, stress: float, jacobian: Jacobian, loss: Loss, radius: float) -> tuple[Floats, float]:
    """The step of the loss, and by how much it lowers the stress of the linearised problem."""
    step = loss.step(jacobian, here.residuals, radius)
    return step, stress - loss.value(here.residuals + jacobian.apply(step))


def _tried(
    here: Placement, stress: float, displacement: Floats, predicted: float, loss: Loss, walled: bool
) -> tuple[Placement, float]:
    """The placement after the walk, and its gain as a share of what was predicted.

    A poor step is tried again without the points whose own residuals increased; then the share is at most 1/2.
    """
    end = walk(here.points, displacement, walled=walled)
    there = here.problem.at(turned_over(end)[0] if walled else end)
    ratio = (stress - loss.value(there.residuals)) / predicted
    if ratio > 0.25:
        return there, ratio
    there = _without_setbacks(here, there)
    return there, min((stress - loss.value(there.residuals)) / predicted, 0.5)


def _without_setbacks(here: Placement, there: Placement) -> Placement:
    """`there`, with the points back in place whose own squared residuals increased."""
    return here.problem.at(mixed(there.shares < here.shares, there.points, here.points))


def _resized(radius: float, ratio: float) -> float:
    """Twice the radius where the linearisation predicted the gain well, a half or a quarter where it did not."""
    factor = 2.0 if ratio > 0.75 else 1.0 if ratio > 0.25 else 0.5 if ratio > 0 else 0.25
    return float(np.clip(factor * radius, SHORTEST, LONGEST))


@dataclass(frozen=True)
class Settler:
    """A free descent, then a walled one, with one loss and tolerance; `report` hears of each iteration."""

    loss: Loss
    tolerance: float
    report: Callable[[int], None]

    def __call__(self, here: Placement, max_iterations: int, radius: float | None = None) -> Descent:
        """From `here`, with a first trust region of `radius`, or of twice the root-mean-square residual."""
        if radius is None:
            radius = float(np.clip(2 * np.sqrt(np.mean(here.residuals**2)), SHORTEST, LONGEST))
        start = Descent(here, self.loss.value(here.residuals), radius)
        descent = functools.partial(
            descend, loss=self.loss, tolerance=self.tolerance, max_iterations=max_iterations, report=self.report
        )
        free = descent(start, walled=False)
        if free.status is Status.ITERATION_LIMIT or free.predicted == 0:
            return free
        again = replace(free, radius=min(radius, WALLED))
        return descent(again, walled=True)
