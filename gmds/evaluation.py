"""The judge: how far mapped points are from where they should be. It knows geodesics and truth, never the solver.

The protocol of the field: geodesic distance on the target, in the metric of space, between the mapped and the true
point, divided by sqrt(target area). `direct` is against the true correspondence, `sym` against the left-right
flipped one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats, Integers
from geodesics.distance import Distance
from geodesics.mesh import Mesh
from geodesics.one_ring import one_ring_areas
from geodesics.points import SurfacePoints
from gmds.errors import MapError
from gmds.maps.point_distances import distances_between
from gmds.maps.point_map import PointMap

PROTOCOL_POINTS = 125  # a convention: as many as all published figures of this project are of


@dataclass(frozen=True)
class ErrorSummary:
    """Errors of one map by the protocol of the field.

    Attributes
    ----------
    count : int
        How many points were judged.
    mean, median : float
        Of the errors, times 100.
    within_005, within_010, within_025 : float
        Percentages of errors of at most 0.05, 0.10 and 0.25.

    See Also
    --------
    summary : Makes it.

    Examples
    --------
    >>> import gmds
    >>> gmds.summary([0.01, 0.02, 0.3, 0.08]).count
    4
    """

    count: int
    mean: float
    median: float
    within_005: float
    within_010: float
    within_025: float


def geodesic_error(
    answer: PointMap | SurfacePoints,
    truth: SurfacePoints | ArrayLike,
    source_indices: ArrayLike | None = None,
    *,
    distance: Distance | None = None,
) -> Floats:
    r"""Geodesic distance from each mapped point to its true point, over the root of the target's area.

    .. math:: e_i = d_Y(\rho(x_i), y_i) / \sqrt{\mathrm{area}(Y)}

    Parameters
    ----------
    answer : Correspondence or SurfacePoints
        The map :math:`\rho` of n source vertices, or n mapped points. Points that are not `valid` are judged as well.
    truth : SurfacePoints or array of shape (p,)
        The true points :math:`y_i` on the target, or its vertices.
    source_indices : array of shape (p,), optional
        Which source vertices :math:`x_i` they belong to; without it there is a true point for every vertex.
    distance : Distance, optional
        What measures :math:`d_Y`, in units of length. Geodesics in the metric of space unless given.

    Returns
    -------
    array of shape (p,)
        Errors >= 0, without unit.

    Raises
    ------
    MapError
        E310, when rows do not fit or the truth is on another mesh.

    See Also
    --------
    summary : The figures that are published.
    error_curve : The share of points within every threshold.

    Notes
    -----
    Each distinct true point costs one march, 1.7 ms on 5,000 vertices (8 s for all of them) and in proportion to their
    number; memory is that of 64 marches, however many there are. Of a large mesh judge some rows, by `source_indices`.
    Distances from it are linear on faces, but straight between two points of one face. Where the true point is out of
    reach, on another component, the error is the largest that is within reach.

    References
    ----------
    The protocol of V. G. Kim, Y. Lipman and T. Funkhouser, "Blended intrinsic maps", ACM Trans. Graph. 30 (2011).

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped, truth
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> true = truth(source, target)
    >>> answer = gmds.Correspondence.from_points(source, true)
    >>> float(gmds.geodesic_error(answer, true).max().round(6))
    0.0
    """
    points = answer if isinstance(answer, SurfacePoints) else getattr(answer, "points", None)
    if not isinstance(points, SurfacePoints):
        raise TypeError(f"a map or its points are expected, not {type(answer).__name__}; of a matrix take .points()")
    if source_indices is not None:
        points = points[_checked(source_indices, len(points))]
    target = points.mesh
    if not isinstance(truth, SurfacePoints):
        truth = SurfacePoints.at_vertices(target, np.asarray(truth, dtype=np.int64))
    if truth.mesh is not target:
        raise MapError("the truth lies on another mesh than the map's target; both must be the same object")
    if len(truth) != len(points):
        raise MapError(f"{len(truth)} truth points for {len(points)} mapped points; name the rows by source_indices")
    return distances_between(points, truth, distance or _embedded_geodesics(target)) / np.sqrt(target.area)


def errors_of_maps(answer: PointMap, truth: SurfacePoints | ArrayLike, source_indices: ArrayLike) -> Floats:
    """The `geodesic_error` of a map and of each of its candidates, (1 + candidates, n); NaN where no truth is given.

    `truth` and `source_indices` (p,) as there.
    """
    maps = [answer.points, *(one.points for one in answer.candidates)]
    errors = np.full((len(maps), len(answer.points)), np.nan)
    rows = _checked(source_indices, len(answer.points))
    for row, points in zip(errors, maps, strict=True):
        row[rows] = geodesic_error(points, truth, rows)
    return errors


def error_curve(errors: ArrayLike, thresholds: ArrayLike | None = None) -> Floats:
    """The cumulative curve of errors: how many of them are at most each threshold.

    Parameters
    ----------
    errors : array of shape (p,)
        As `geodesic_error` gives them.
    thresholds : array of shape (t,), optional
        0, 0.01, ... 0.25 unless given.

    Returns
    -------
    array of shape (t,)
        Shares in [0, 1].

    Raises
    ------
    MapError
        E310, when there are no errors.

    Examples
    --------
    >>> import gmds
    >>> gmds.error_curve([0.01, 0.02, 0.3, 0.08], [0.05, 0.1, 0.25]).tolist()  # shares of the points
    [0.5, 0.75, 0.75]
    """
    thresholds = np.linspace(0, 0.25, 26) if thresholds is None else np.asarray(thresholds, dtype=np.float64)
    ordered = np.sort(np.asarray(errors, dtype=np.float64).ravel())
    if len(ordered) == 0:
        raise MapError("there are no errors to make a curve of")
    return np.searchsorted(ordered, thresholds, side="right") / len(ordered)


def summary(errors: ArrayLike) -> ErrorSummary:
    """The figures by which maps are compared.

    Parameters
    ----------
    errors : array of shape (p,)
        As `geodesic_error` gives them.

    Returns
    -------
    ErrorSummary
        Mean and median times 100, and the percentages within 0.05, 0.10 and 0.25.

    Raises
    ------
    MapError
        E310, when there are no errors.

    Examples
    --------
    >>> import gmds
    >>> found = gmds.summary([0.01, 0.02, 0.3, 0.08])
    >>> found.mean, found.within_010
    (10.25, 75.0)
    """
    errors = np.asarray(errors, dtype=np.float64).ravel()
    within = 100 * error_curve(errors, [0.05, 0.10, 0.25])
    return ErrorSummary(len(errors), 100 * float(errors.mean()), 100 * float(np.median(errors)), *within.tolist())


def protocol_subset(count: int, size: int = PROTOCOL_POINTS) -> Integers:
    """Which of `count` truth points are judged: `size` of them, evenly spread over the list, always the same."""
    return np.unique(np.linspace(0, count - 1, min(size, count)).round().astype(np.int64))


def coverage(answer: PointMap) -> float:
    """The share in [0, 1] of the target's area that belongs to vertices some source vertex is mapped to."""
    target = answer.target
    area = one_ring_areas(target)
    return float(area[np.unique(answer.vertex_map()[answer.valid])].sum() / area.sum())


def _embedded_geodesics(target: Mesh) -> Distance:
    from geodesics import GeodesicDistance, embedded

    return GeodesicDistance(embedded(target))


def _checked(indices: ArrayLike, rows: int) -> Integers:
    indices = np.asarray(indices, dtype=np.int64).reshape(-1)
    bad = np.flatnonzero((indices < 0) | (indices >= rows))
    if len(bad):
        raise MapError(f"source index {indices[bad[0]]} does not exist; the map has {rows} rows")
    return indices
