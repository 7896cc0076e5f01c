"""The judge: how far mapped points are from where they should be. It knows geodesics and truth, never the solver.

The protocol of the field: geodesic distance on the target, in the metric of space, between the mapped and the true
point, divided by sqrt(target area). `direct` is against the true correspondence, `sym` against the left-right
flipped one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Bools, Floats, Integers
from geodesics.distance import Distance
from geodesics.mesh import Mesh
from geodesics.one_ring import one_ring_areas
from geodesics.points import SurfacePoints
from gmds.errors import MapError
from gmds.maps.point_map import PointMap

PROTOCOL_POINTS = 125
CHUNK = 64  # truth points marched at once, so that memory stays at CHUNK times the vertices


@dataclass(frozen=True)
class ErrorSummary:
    """Errors of one map: mean and median times 100, and the percentage within 0.05, 0.10 and 0.25."""

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
    """Geodesic distance from each mapped point to its true point over sqrt(target area): (p,) errors >= 0.

    `truth`: p points of the target, or p target vertex indices. `source_indices` (p,): which source vertices they
    belong to; None means one truth point for every row. Rows that are not `valid` are judged like all others.
    `distance`: geodesic in the embedded metric unless given (an exact one, say). Each distinct truth point costs one
    march; its distances are linear on faces, except that a mapped point on a face that holds the true point is
    measured straight. A mapped point that cannot be reached from the true one (another component) gets the largest
    distance that can be reached. Raises `MapError` when rows do not fit or the truth is on another mesh.
    """
    points = answer if isinstance(answer, SurfacePoints) else answer.points
    if source_indices is not None:
        points = points[_checked(source_indices, len(points))]
    target = points.mesh
    if not isinstance(truth, SurfacePoints):
        truth = SurfacePoints.at_vertices(target, np.asarray(truth, dtype=np.int64))
    if truth.mesh is not target:
        raise MapError("the truth lies on another mesh than the map's target; both must be the same object")
    if len(truth) != len(points):
        raise MapError(f"{len(truth)} truth points for {len(points)} mapped points; name the rows by source_indices")
    marched = _marched(points, truth, distance or _embedded_geodesics(target))
    straight = np.linalg.norm(points.positions - truth.positions, axis=1)
    return np.where(_on_one_face(points, truth), straight, marched) / np.sqrt(target.area)


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
    """The share in [0, 1] of errors at most each threshold, (t,); thresholds are 0, 0.01 .. 0.25 unless given."""
    thresholds = np.linspace(0, 0.25, 26) if thresholds is None else np.asarray(thresholds, dtype=np.float64)
    ordered = np.sort(np.asarray(errors, dtype=np.float64).ravel())
    if len(ordered) == 0:
        raise MapError("there are no errors to make a curve of")
    return np.searchsorted(ordered, thresholds, side="right") / len(ordered)


def summary(errors: ArrayLike) -> ErrorSummary:
    """Mean and median times 100, and the percentage of errors within 0.05, 0.10 and 0.25."""
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


def _marched(points: SurfacePoints, truth: SurfacePoints, distance: Distance) -> Floats:
    """Distance (p,) by linear interpolation of one field per distinct truth point."""
    _, first, which = np.unique(
        np.column_stack([truth.face, truth.barycentric]), axis=0, return_index=True, return_inverse=True
    )
    which = which.reshape(-1)
    corners = points.mesh.faces[points.face]
    result = np.empty(len(points))
    for start in range(0, len(first), CHUNK):
        field = distance.field(truth[first[start : start + CHUNK]])
        reach = np.where(np.isfinite(field), field, -1).max(axis=1, keepdims=True)
        field = np.where(np.isfinite(field), field, reach)
        rows = np.flatnonzero((which >= start) & (which < start + CHUNK))
        values = field[(which[rows] - start)[:, None], corners[rows]]
        result[rows] = (values * points.barycentric[rows]).sum(axis=1)
    return result


def _on_one_face(points: SurfacePoints, truth: SurfacePoints) -> Bools:
    """True where every corner that carries the true point is a corner of the mapped point's face, (p,)."""
    mapped, true = points.mesh.faces[points.face], truth.mesh.faces[truth.face]
    shared = (true[:, :, None] == mapped[:, None, :]).any(axis=2)
    return (shared | (truth.barycentric <= 0)).all(axis=1)


def _checked(indices: ArrayLike, rows: int) -> Integers:
    indices = np.asarray(indices, dtype=np.int64).reshape(-1)
    bad = np.flatnonzero((indices < 0) | (indices >= rows))
    if len(bad):
        raise MapError(f"source index {indices[bad[0]]} does not exist; the map has {rows} rows")
    return indices
