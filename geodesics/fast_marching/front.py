"""The tables of a marching front: corners, lengths and slowness of the triangles that it crosses."""

from __future__ import annotations

import numpy as np

from geodesics._kernels import marching
from geodesics.arrays import Floats, Integers
from geodesics.caching import memoized
from geodesics.delaunay import GluedTriangulation, glued, glued_delaunay, glued_faces, mollified, wrapped
from geodesics.intrinsic import angles
from geodesics.mesh import Mesh
from geodesics.metric import Metric

Rows = tuple[Integers, Integers, Integers, Floats]


@memoized
def triangulation(metric: Metric) -> GluedTriangulation:
    """The triangles to march over: intrinsic Delaunay, or the mesh's own where lengths may differ across edges."""
    if metric.conformal_factor is not None:
        return glued_delaunay(metric.mesh)
    own = glued_faces(metric.mesh)
    lengths = mollified(np.sqrt(metric.l_sq[own.origin]))
    return glued(metric.mesh.faces[own.origin], lengths, own.origin, metric.mesh.n_vertices)


@memoized
def corners(metric: Metric) -> marching.Corners:
    """The corners of the triangulation, grouped by vertex, and the slowness of their faces."""
    start, order, ends, shape = rows(metric)
    slowness = speeds(metric)[triangulation(metric).faces].mean(axis=1)
    return marching.Corners(start, ends, shape, slowness[order // 3])


def speeds(metric: Metric) -> Floats:
    """Length in the metric per length in its triangulation, at every vertex (n,)."""
    rho = metric.conformal_factor
    return np.ones(metric.mesh.n_vertices) if rho is None else np.sqrt(rho)


def rows(metric: Metric) -> Rows:
    """First row of each vertex (n + 1,), corner 3 * face + k of each row (3 m,), ends (3 m, 2) and shape (3 m, 8)."""
    return _embedded_rows(metric.mesh) if metric.conformal_factor is not None else _own_rows(metric)


@memoized
def _embedded_rows(mesh: Mesh) -> Rows:
    """What all conformal metrics share."""
    return _rows(glued_delaunay(mesh), mesh.n_vertices)


@memoized
def _own_rows(metric: Metric) -> Rows:
    """What belongs to this metric alone."""
    return _rows(triangulation(metric), metric.mesh.n_vertices)


def _rows(grid: GluedTriangulation, n: int) -> Rows:
    order = np.argsort(grid.faces.ravel(), kind="stable")
    start = np.append(0, np.cumsum(np.bincount(grid.faces.ravel(), minlength=n)))
    angle = angles(grid.lengths**2)
    following, preceding = [1, 2, 0], [2, 0, 1]
    leaving, arriving = grid.direction, wrapped(grid.direction + angle, grid.whole[grid.faces])
    columns = [grid.lengths[:, preceding], grid.lengths[:, following], np.cos(angle), np.sin(angle)]
    columns += [leaving, arriving, arriving[:, following], leaving[:, preceding]]
    shape = np.stack([c.ravel()[order] for c in columns], axis=1)
    ends = np.stack([grid.faces[:, c].ravel()[order] for c in (following, preceding)], axis=1)
    return start, order, np.ascontiguousarray(ends), np.ascontiguousarray(shape)


@memoized
def longest_edges(metric: Metric) -> Floats:
    """Length in the metric of the longest edge at every vertex (n,), 0 at an isolated one."""
    table = corners(metric)
    longest, some = np.zeros(metric.mesh.n_vertices), table.start[:-1] < table.start[1:]
    if some.any():
        edges = table.shape[:, :2].max(axis=1) * table.slowness
        longest[some] = np.maximum.reduceat(edges, table.start[:-1][some])
    return longest


def fresh_front(metric: Metric) -> marching.Front:
    """A front that has reached nothing yet."""
    n = metric.mesh.n_vertices
    state = np.full((n, 6), np.inf)
    state[:, 3], state[:, 4], state[:, 5] = triangulation(metric).whole, speeds(metric), 2 * longest_edges(metric)
    position, visits = np.full(n, marching.UNSEEN, dtype=np.int64), np.zeros(n, dtype=np.int64)
    heap, keys, touched = np.zeros(n, dtype=np.int64), np.zeros(n), np.zeros(n, dtype=np.int64)
    return marching.Front(state, position, visits, heap, keys, touched, np.zeros(2, dtype=np.int64))
