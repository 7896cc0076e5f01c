"""Distances known only as fields: solve with the fields frozen, march again, repeat."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats
from gmds.mds.descent import Descent, Settler
from gmds.mds.pair_distances import FieldPairs
from gmds.mds.problem import Placement
from gmds.mds.status import Status


@dataclass(frozen=True, eq=False)
class FrozenDistance:
    """Distances between p moving points, by the fields (p, n) marched from where they once were.

    d(x_i, x_j) = f_i(x_j) + f_j(x_i) - d_0, d_0 (p, p) being the distances then: exact while one of the two moves,
    and wrong by the product of both moves over the distance when both do.
    """

    mesh: Mesh
    fields: Floats
    reference_distances: Floats

    def field(self, points: SurfacePoints) -> Floats:
        """The frozen fields (p, n)."""
        return self.fields

    def pairs(self, points: SurfacePoints) -> FrozenPairs:
        """Distances between the points where they are now."""
        return FrozenPairs(FieldPairs(points, self.fields), self.reference_distances)


@dataclass(frozen=True, eq=False)
class FrozenPairs:
    """All distances between p points of a `FrozenDistance`."""

    now: FieldPairs
    reference_distances: Floats

    def distances(self) -> Floats:
        """Symmetric (p, p), never negative."""
        with np.errstate(invalid="ignore"):
            distances = 2 * self.now.distances() - self.reference_distances
        return np.where(np.isfinite(distances), np.maximum(distances, 0.0), np.inf)

    def derivatives(self, distances: Floats) -> Floats:
        """(p, 2, p), as `FieldPairs.derivatives`."""
        return self.now.derivatives(distances)


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
    distance = FrozenDistance(here.points.mesh, fields, here.distances)
    return here.problem.towards(distance).at(here.points)
