"""Distances known only as fields: solve with the fields frozen, march again, repeat."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats, Integers
from gmds.mds.descent import Descent, Settler
from gmds.mds.field_pairs import FieldPairs
from gmds.mds.problem import Placement
from gmds.mds.status import Status


@dataclass(frozen=True, eq=False)
class FrozenDistance:
    """Distances of r pairs of p moving points, by the fields (p, n) marched from where they once were.

    d(x_i, x_j) = f_i(x_j) + f_j(x_i) - d_0, d_0 (r,) being the distances then: exact while one of the two moves,
    and wrong by the product of both moves over the distance when both do.
    """

    mesh: Mesh
    fields: Floats
    reference_lengths: Floats

    def field(self, points: SurfacePoints) -> Floats:
        """The frozen fields (p, n)."""
        return self.fields

    def pairs(self, points: SurfacePoints) -> FrozenPairs:
        """Distances between the points where they are now."""
        return FrozenPairs(FieldPairs(points, self.fields), self.reference_lengths)


@dataclass(frozen=True, eq=False)
class FrozenPairs:
    """The r pairs of p points of a `FrozenDistance`."""

    now: FieldPairs
    reference_lengths: Floats

    def lengths(self, first: Integers, second: Integers) -> Floats:
        """Distances (r,) of the pairs, never negative; they are those that the distance was frozen with."""
        with np.errstate(invalid="ignore"):
            lengths = 2 * self.now.lengths(first, second) - self.reference_lengths
        return np.where(np.isfinite(lengths), np.maximum(lengths, 0.0), np.inf)

    def slopes(self, first: Integers, second: Integers, lengths: Floats, scale: Floats) -> Floats:
        """(r, 2, 2), as `FieldPairs.slopes`."""
        return self.now.slopes(first, second, lengths, scale)


def remarch(start: Placement, settle: Settler, max_iterations: int, max_rounds: int = 20) -> Descent:
    """Let `settle` lower the stress with frozen fields, march anew, keep what holds; at most `max_rounds` times.

    Ends when the frozen problem promises less than the tolerance, or what it promises does not come true even for
    single short steps. `predicted` of the answer is all that the last frozen problem promised and did not keep.
    """
    loss, here, iteration = settle.loss, start, 0
    stress, radius = loss.value(start.residuals), None
    for _ in range(max_rounds):
        allowed = max_iterations - iteration if radius is None else 1
        last = settle(frozen(here), allowed, radius)
        iteration += last.iteration
        promised = stress - last.stress
        there = here.problem.at(last.here.points) if promised > 0 else here
        gain = stress - loss.value(there.residuals)
        if gain > 0:
            here, stress = there, loss.value(there.residuals)
        ended = last.status is not Status.ITERATION_LIMIT
        unkept = promised - max(gain, 0.0) + (last.predicted if ended else 0.0)
        answer = replace(last, here=here, stress=stress, iteration=iteration, predicted=unkept)
        if ended and promised <= settle.tolerance * stress:
            return replace(answer, status=last.status)
        if gain <= 0 and radius is not None and radius < 1e-3:
            return replace(answer, status=Status.STALLED)
        if iteration >= max_iterations:
            break
        radius = None if gain > 0 else 0.05 if radius is None else radius / 8
    return replace(answer, predicted=np.inf, status=Status.ITERATION_LIMIT)


def frozen(here: Placement) -> Placement:
    """The same placement, of the problem whose fields stay as they are here."""
    fields = cast(FieldPairs, here.pairs).fields
    distance = FrozenDistance(here.points.mesh, fields, here.lengths)
    return here.problem.towards(distance).at(here.points)
