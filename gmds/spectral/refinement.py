"""From a rough map to a good one, in the metric that suits the pair."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.caching import cached_property
from gmds.spectral.conformal_metrics import ConformalClass
from gmds.spectral.extension import FEWEST, closest_points
from gmds.spectral.functional_maps import functional_map, nearest_rows, spectral_upsampling
from gmds.surface.measured import Surface
from gmds.surface.view import View

# Heat time, in units of the area, that smooths the factor, and the numbers of eigenfunctions after; coarse to fine.
# Each of three rounds lessened the error of scaled development pairs (benchmarks/results/notes.md, "Alignment").
ROUNDS: tuple[tuple[float, tuple[int, ...]], ...] = (
    (3e-3, (16, 20, 24, 28, 32, 40)),
    (2e-3, (20, 28, 40, 50)),
    (1e-3, (24, 40, 60)),
)
LADDER = (16, 20, 24, 28, 32, 40, 50, 60)  # numbers of eigenfunctions without an alignment, from rough maps on
# Source vertices by which a map goes from one round to the next, and target vertices that they may be sent to. Set by
# hand: all vertices would cost several times as much.
CARRIERS = 1500
GOALS = 2500
STEP_GOALS = 1500  # target vertices between one number of eigenfunctions and the next ("Effort" there)
PER_FUNCTION = 15  # samples that each eigenfunction is fitted to, at the least; set by hand
# Eigenfunctions, at the most, that placed samples are continued with, samples for each of them, at the least, and the
# weight of the map before as a share of theirs: on three development pairs a tenth keeps what samples do not cover, and
# as much as all of it takes a quarter of what they gain (benchmarks/results/notes.md, "Plain GMDS").
CONTINUED = 60
PER_CONTINUED = 5
KEPT = 0.1
FITTED = 500  # the first samples, to which functional maps are fitted; set by hand


@dataclass(frozen=True, eq=False)
class Refiner:
    """Refines maps between two surfaces; a map is an index array (n,) of target vertices."""

    source: Surface
    target: Surface

    @cached_property
    def factors(self) -> ConformalClass:
        """The metrics of the target among which the right one is sought."""
        return ConformalClass(self.target)

    @cached_property
    def _carriers(self) -> tuple[Integers, Floats]:
        """Farthest points of the source, and the area nearest to each."""
        cells, used = self.source.regular.cells(CARRIERS), self.source.regular.usable
        share = np.bincount(cells.nearest[used], self.source.areas[used], len(cells.samples))
        return cells.samples, share.astype(np.float64)

    @cached_property
    def _goals(self) -> Integers:
        """Farthest points of the target."""
        return self.target.regular.samples(GOALS)

    def aligned(self, images: Integers, rounds: Sequence[int]) -> tuple[Integers, View]:
        """A map refined in the metric of the target in which it keeps area, and the target in that metric.

        Each of the `rounds`, indices into `ROUNDS`, finds that metric for the map so far, and refines the map by
        spectral upsampling from few eigenfunctions to many.
        """
        (carriers, share), ours, view = self._carriers, self.source.regular, self.target.regular
        sent, matrix = images[carriers], np.eye(1)
        for number in rounds:
            time, sizes = ROUNDS[number]
            amounts = np.bincount(sent, share, minlength=len(view.functions)).astype(np.float64)
            view = self.factors.view(self.factors.density(amounts, time), sizes[-1])
            steps = _available(sizes, ours, view)
            fitted, rows = slice(FITTED), ours.functions[carriers]
            matrix, _ = spectral_upsampling(rows[fitted], view.functions, sent[fitted], steps, self._goals)
            sent = _images(rows, view, matrix, self._goals)
        return _images(ours.functions, view, matrix, view.usable), view

    def continued(self, samples: Integers, placed: SurfacePoints, before: SurfacePoints) -> SurfacePoints:
        """The map (n,) that continues samples (p,) placed at p points, and what was `before` (n,) where there are none.

        A functional map into the metric of the target in which the map keeps area, that before to begin with and then
        the map itself, is fitted to the placed samples and, with `KEPT` of their weight, to the whole map before. The
        metric that they were placed in has no part in this: where it has hardly any area, its eigenfunctions cannot
        tell points apart.
        """
        carriers, _ = self._carriers
        size = max(FEWEST, min(CONTINUED, len(samples) // PER_CONTINUED))
        weight = np.sqrt(KEPT * len(samples) / len(carriers))
        points = before
        for _ in range(2):
            rows, view = self._keeping_area(points, size)
            there = view.functions[:, : rows.shape[1]]
            ours = np.vstack([rows[samples], weight * rows[carriers]])
            theirs = np.vstack([placed.interpolate(there), weight * before[carriers].interpolate(there)])
            points = closest_points(view, there @ functional_map(ours, theirs).T, rows)
        return points

    def resolved(self, points: SurfacePoints) -> SurfacePoints:
        """The map to `points` (n,), written in all eigenfunctions, in the metric in which it keeps area."""
        carriers, _ = self._carriers
        rows, view = self._keeping_area(points, self.source.count)
        there = view.functions[:, : rows.shape[1]]
        matrix = functional_map(rows[carriers], points[carriers].interpolate(there))
        return closest_points(view, there @ matrix.T, rows)

    def _keeping_area(self, points: SurfacePoints, count: int) -> tuple[Floats, View]:
        """Eigenfunctions (n, k) of the source, at most `count`, and the target where a map keeps area."""
        carriers, share = self._carriers
        sent = points.nearest_vertices()[carriers]
        amounts = np.bincount(sent, share, minlength=self.target.mesh.n_vertices).astype(np.float64)
        view = self.factors.view(self.factors.density(amounts, ROUNDS[-1][0]), count)
        k = min(view.functions.shape[1], self.source.regular.functions.shape[1])
        return self.source.regular.functions[:, :k], view


def upsampled(source: View, target: View, images: Integers, sizes: Sequence[int] = LADDER) -> Integers:
    """A map (n,) to target vertices refined by spectral upsampling between two given views.

    `sizes`: the numbers of eigenfunctions; `PER_FUNCTION` samples for each of the last.
    """
    steps = _available(sizes, source, target)
    samples = source.samples(max(FITTED, PER_FUNCTION * steps[-1]))
    goals = target.samples(STEP_GOALS)
    matrix, _ = spectral_upsampling(source.functions[samples], target.functions, images[samples], steps, goals)
    return _images(source.functions, target, matrix, target.usable)


def _images(rows: Floats, target: View, matrix: Floats, goals: Integers) -> Integers:
    """For each row (p, k) of source functions the vertex among `goals` that a functional map sends it to."""
    k = len(matrix)
    return goals[nearest_rows(rows[:, :k], target.functions[goals, :k] @ matrix.T)]


def _available(sizes: Sequence[int], source: View, target: View) -> list[int]:
    """The sizes, cut off at the number of eigenfunctions there are."""
    most = min(source.functions.shape[1], target.functions.shape[1])
    return sorted({min(k, most) for k in sizes})
