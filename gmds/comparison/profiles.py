"""What a surface is compared by before any map is known: from each equal share of it, how far the others are."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import cdist

from geodesics import Mesh, Metric, eigenpairs, scale_invariant
from geodesics.arrays import Floats, Integers
from geodesics.euclidean import euclidean_distances
from geodesics.sampling import farthest_point_cells
from gmds.surface.measured import EXPONENTS, SMOOTHING, Surface, measure
from gmds.surface.view import View

FUNCTIONS = 40  # eigenfunctions of the commute-time distance
CELLS = 120  # of farthest points, whose areas make the shares
EQUAL_AREA_SAMPLES = 100  # vertices, each standing for as much area of the surface
QUANTILES = 40  # that tell the distances from a share to all others

METRICS: tuple[Callable[[Mesh], Metric], ...] = tuple(
    functools.partial(scale_invariant, exponent=a, smoothing=SMOOTHING) for a in EXPONENTS
)
"""The metrics in which shapes are compared."""


def distance_profile(mesh: Mesh | Surface, metrics: Sequence[Callable[[Mesh], Metric]] = METRICS) -> Floats:
    """Quantiles of the distances from each of 100 equal shares of a surface to all of them: (metrics, shares, 40).

    Distances are commute-time distances (3.2) over their mean, areas those of the metric, and the metrics the members
    1 and 1/2 of the family |K|^a g (2.1): the size of the surface has no part in it, that of its parts a small one. The
    first is made for parts that changed much, the second for those that did not. Raises `TooFewVertices` (E113).
    """
    return np.stack([_quantiles(normalised_distances(view, equal_area_samples(view))) for view in views(mesh, metrics)])


def least_distortion(one: Floats, other: Floats) -> float:
    """The distortion that no map between two surfaces that keeps area goes below, by their profiles.

    A map that sends share x to y distorts the distances from x by at least as much as it takes to move the distribution
    of all distances from x onto that of all distances from y; the best assignment of shares to shares bounds the mean
    over all x (the third lower bound of the Gromov-Wasserstein distance: Memoli, Found. Comput. Math. 11, 2011). The
    mean over the metrics. Symmetric, 0 for isometric or similar surfaces, with the triangle inequality; up to sampling.
    `dissimilarity` seeks the map itself, and is not confined to those that keep area.
    """
    return float(np.mean([_assigned(ours, theirs) for ours, theirs in zip(one, other, strict=True)]))


def views(mesh: Mesh | Surface, metrics: Sequence[Callable[[Mesh], Metric]] = METRICS) -> tuple[View, ...]:
    """The surface in the metrics in which it is compared, each with `FUNCTIONS` eigenfunctions."""
    surface = mesh if isinstance(mesh, Surface) else measure(mesh)
    count = min(FUNCTIONS, surface.count)
    return tuple(View.of(eigenpairs(metric(surface.mesh), count)) for metric in metrics)


def equal_area_samples(view: View) -> Integers:
    """Vertices (100,) that stand for equal areas: farthest points, each as often as its Voronoi cell is large."""
    distance, used = view.distance(FUNCTIONS), view.usable
    first = int((distance.embedding**2).sum(axis=1).argmax())
    cells = farthest_point_cells(distance, min(CELLS, len(used)), first)
    area = np.bincount(cells.nearest[used], view.spectrum.mass[used], len(cells.samples))
    wanted = EQUAL_AREA_SAMPLES * area / area.sum()
    times = np.floor(wanted).astype(np.int64)
    times[np.argsort(times - wanted, kind="stable")[: EQUAL_AREA_SAMPLES - times.sum()]] += 1
    return np.repeat(cells.samples, times)


def normalised_distances(view: View, vertices: Integers) -> Floats:
    """Commute-time distances between vertices (p, p) over the mean of those between equal-area samples."""
    return _between(view, vertices) / _between(view, equal_area_samples(view)).mean()


def _between(view: View, vertices: Integers) -> Floats:
    rows = view.commute_time_embedding[vertices]
    return euclidean_distances(rows, rows)


def _quantiles(distances: Floats) -> Floats:
    """From each row (p, p) its quantiles at the middle of equal steps (p, `QUANTILES`)."""
    return np.quantile(distances, (np.arange(QUANTILES) + 0.5) / QUANTILES, axis=1).T


def _assigned(ours: Floats, theirs: Floats) -> float:
    """The least mean L1 distance between rows, over all ways to assign them to each other."""
    cost = cdist(ours, theirs, "cityblock") / ours.shape[1]
    return float(cost[linear_sum_assignment(cost)].mean())
