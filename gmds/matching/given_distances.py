"""Plain generalised multidimensional scaling, in distances that are given: placed, continued, placed again."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from geodesics import Distance, Mesh, SurfacePoints
from geodesics.arrays import Floats, Integers
from gmds.matching.pair import SurfacePair
from gmds.mds.ladder import rungs_below, solve_by_ladder
from gmds.mds.losses import LeastSquares, Loss
from gmds.mds.many_samples import pairs_asked
from gmds.mds.pair_distances import pairwise
from gmds.mds.problem import Problem
from gmds.mds.solver import Solution
from gmds.mds.tabulated import TabulatedDistance
from gmds.registration.register import assessed
from gmds.registration.settings import FULL
from gmds.registration.thin_plate import ThinPlate
from gmds.spectral.refinement import ROUNDS
from gmds.surface.measured import Surface, view_of
from gmds.surface.view import View

# Times that samples are placed, from where the map that continues them has them: on a scaled development pair the
# second time lowers the error by a twentieth, a third does nothing (benchmarks/results/notes.md, "Plain GMDS").
TIMES = 2
# Pairs weigh 1 / (d + NEAR mean d)^2, so that it is shares of distances that are kept, where the loss is smooth: what
# bends at joints, or saturates, adds up over far pairs (chosen on development pairs, from the true places: there too).
NEAR = 0.1
# Times that the map is written in all eigenfunctions, and smoothed, after a spline through the samples: on development
# pairs the first lowers the error by a tenth, the second by a thirtieth (the same place).
SMOOTHED = 2
ITERATIONS = 30  # of the solver, each time; chosen with them
SAME_MASS = 1e-3  # of the mean, by which the masses of two metrics differ at most that are one but for size: a bound


class GivenDistances(NamedTuple):
    """Distances on source and target that a user gave, and both surfaces in their metrics."""

    views: tuple[View, View]
    distances: tuple[Distance, Distance]

    @classmethod
    def of(cls, source: Surface, target: Surface, distance: Callable[[Mesh], Distance]) -> GivenDistances:
        """What `distance` makes of both; what is neither an embedding nor says how pairs are measured is tabulated."""
        made = distance(source.mesh), distance(target.mesh)
        views = view_of(made[0], source), view_of(made[1], target)
        return cls(views, (_quick(made[0]), _quick(made[1])))

    def differ_from(self, others: tuple[View, View]) -> bool:
        """Whether the metrics are others than those of these views, up to size."""
        gaps = [abs(one.spectrum.mass - other.spectrum.mass) for one, other in zip(self.views, others, strict=True)]
        return any(len(gap) * gap.max() > SAME_MASS for gap in gaps)  # masses of a view sum to 1


def _quick(distance: Distance) -> Distance:
    """The distance, if it has coordinates or measures pairs itself, else tabulated."""
    if hasattr(distance, "embedding") or hasattr(distance, "pairs"):
        return distance
    return TabulatedDistance(distance)


def placed_in_given(
    pair: SurfacePair, images: Integers, given: GivenDistances, loss: Loss, count: int
) -> tuple[SurfacePoints, Solution]:
    """The map `images` (n,) after generalised multidimensional scaling in the given distances, without registration.

    It is first refined in the metric in which it keeps area. Then `count` farthest points, in turn of the given metric
    and of space, are placed so that the given distances agree, and the map is continued from them; that is done `TIMES`
    times, each from where the last left off, as what is smooth leaves minima that are not. Last it is made smooth, by
    splines. Shares of distances are to agree, near pairs weigh more; but a loss that is sharp at its minimum is that of
    the distances themselves, and has its say the last time only, after the smoother ones below it.
    """
    images, _ = pair.refiner.aligned(images, range(len(ROUNDS)))
    points = SurfacePoints.at_vertices(pair.target.mesh, images)
    samples = _interleaved(given.views[0].samples(count), pair.source.regular.samples(count))
    here = SurfacePoints.at_vertices(pair.source.mesh, samples)
    few = pairs_asked(len(here))
    near = relative_weights(pairwise(given.distances[0], here).distances()) if few is None else relative_weights
    plain, shares = (
        Problem(given.distances[0], here, given.distances[1], weights=weights, pairs=few) for weights in (None, near)
    )
    for time in range(TIMES):
        now = LeastSquares() if rungs_below(loss) and time < TIMES - 1 else loss
        problem = plain if rungs_below(now) else shares
        solution = solve_by_ladder(problem, points[samples], now, max_iterations=ITERATIONS)
        placed = pair.with_landmarks(samples, solution.points)
        points = pair.refiner.continued(*placed, points)
    if assessed(*pair.full, points.positions, FULL).residuals.is_congruence:
        return points, solution  # nothing is smoother
    plate = ThinPlate(*pair.full)
    points = plate.through(*placed, points)
    for _ in range(SMOOTHED):
        points = plate.smoothed(pair.refiner.resolved(points))
    return points, solution


def relative_weights(distances: Floats) -> Floats:
    """Weights of pairs at these distances with which it is shares of distances that count, but of the shortest."""
    shortest = NEAR * distances[np.isfinite(distances)].mean()
    return np.asarray((distances + shortest) ** -2.0, dtype=np.float64)


def _interleaved(first: Integers, second: Integers) -> Integers:
    """As many samples as the first has, in turn of either, none twice: farthest points of two metrics."""
    both = np.stack([first, second[: len(first)]], axis=1).ravel()
    _, place = np.unique(both, return_index=True)
    return both[np.sort(place)][: len(first)]
