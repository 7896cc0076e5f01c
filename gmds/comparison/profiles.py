"""What a surface is compared by before any map is known: from each equal share of it, how far the others are."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import cdist

from geodesics import Mesh, Metric, eigenpairs, scale_invariant
from geodesics.arguments import real_numbers
from geodesics.arrays import Floats, Integers
from geodesics.errors import BadShape
from geodesics.euclidean import euclidean_distances
from geodesics.sampling import farthest_point_cells
from gmds.surface.measured import EXPONENTS, SMOOTHING, Surface, measure
from gmds.surface.view import View

# all four chosen on the classes CHOSEN_ON of examples/paper/dissimilarity.py
FUNCTIONS = 40  # eigenfunctions of the commute-time distance
CELLS = 120  # Voronoi cells of farthest points, whose areas say how often each point counts
EQUAL_AREA_SAMPLES = 100  # vertices, each standing for as much area of the surface
QUANTILES = 40  # by which the distances from a sample to all others are described

METRICS: tuple[Callable[[Mesh], Metric], ...] = tuple(
    functools.partial(scale_invariant, exponent=a, smoothing=SMOOTHING) for a in EXPONENTS
)
"""The metrics in which shapes are compared."""


def distance_profile(mesh: Mesh | Surface, metrics: Sequence[Callable[[Mesh], Metric]] = METRICS) -> Floats:
    r"""What a surface is compared by: how distances from each of 100 samples to all others are distributed.

    Distances are commute-time distances (3.2) over their mean, in the metrics :math:`|K|^a g` (2.1) with :math:`a = 1`
    and :math:`1/2`: the size of the surface has no part in the profile, that of its parts a small one. The first metric
    is made for parts that changed much, the second for those that did not. Every sample stands for as much area.

    Parameters
    ----------
    mesh : Mesh or Surface
        The surface; of several components the largest.
    metrics : sequence of functions Mesh -> Metric, optional
        Other metrics than these two.

    Returns
    -------
    array of shape (metrics, 100, 40)
        The 40 quantiles of the distances from each sample, without unit.

    Raises
    ------
    TooFewVertices
        E113.

    See Also
    --------
    least_distortion : Compares two profiles.

    References
    ----------
    (2.1), (3.2); quantiles of distances as in F. Memoli, "Gromov-Wasserstein distances and the metric approach to
    object matching", Found. Comput. Math. 11 (2011).

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> gmds.distance_profile(animal).ndim
    3
    """
    return profile_of_views(views(mesh, metrics))


def profile_of_views(seen: Sequence[View]) -> Floats:
    """The profile of a surface in these metrics."""
    return np.stack([_quantiles(normalised_distances(view, equal_area_samples(view))) for view in seen])


def least_distortion(one: Floats, other: Floats) -> float:
    r"""A lower bound of the distortion of every area-preserving map between two surfaces, from their profiles alone.

    .. math:: \min_\pi \frac{1}{100} \sum_x W_1(\mu_x, \nu_{\pi(x)})

    where :math:`\mu_x` is the distribution of the distances from the sample x to all others, :math:`\pi` runs over
    the assignments of samples to samples and :math:`W_1` is the distance between distributions on a line: a map that
    sends x to y distorts the distances from x by at least as much. The mean over the metrics. Symmetric, 0 for
    isometric or similar surfaces, and with the triangle inequality, up to sampling.

    Parameters
    ----------
    one, other : array of shape (metrics, 100, 40)
        As `distance_profile` gives them.

    Returns
    -------
    float
        The bound, >= 0, in units of the mean distance. It takes a millisecond or two.

    See Also
    --------
    dissimilarity : Seeks the map itself, which need not preserve area.

    References
    ----------
    The third lower bound of the Gromov-Wasserstein distance: F. Memoli, Found. Comput. Math. 11 (2011).

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import humanoid, quadruped
    >>> meshes = quadruped(n_vertices=200), quadruped('walk', n_vertices=200), humanoid(n_vertices=200)
    >>> profiles = [gmds.distance_profile(mesh) for mesh in meshes]
    >>> pose, species = (gmds.least_distortion(profiles[0], other) for other in profiles[1:])
    >>> bool(pose < species)
    True
    """
    one, other = (real_numbers(profile, "profiles, of `distance_profile`,") for profile in (one, other))
    if one.ndim != 3 or one.shape != other.shape:
        raise BadShape(f"profiles must be of one shape (metrics, 100, 40), not {one.shape} and {other.shape}")
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
