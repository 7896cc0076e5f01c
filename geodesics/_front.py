"""What a marching front needs to know of the surface, and where it starts."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from geodesics._kernels import locating, marching
from geodesics._memo import memoized
from geodesics.delaunay import GluedTriangulation, glued, glued_delaunay, glued_faces, mollified, wrapped
from geodesics.intrinsic import angles
from geodesics.mesh import Mesh
from geodesics.metric import Metric
from geodesics.points import SurfacePoints

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


class Seeds(NamedTuple):
    """For each of p points the vertices (p, 3) around it, and distance and direction (p, 3) from each back to it."""

    vertices: Integers
    distances: Floats
    directions: Floats


@memoized
def triangulation(metric: Metric) -> GluedTriangulation:
    """The triangles to march over: intrinsic Delaunay, or the mesh's own where lengths differ across edges."""
    if metric.conformal_factor is not None:
        return glued_delaunay(metric.mesh)
    own = glued_faces(metric.mesh)
    lengths = mollified(np.sqrt(metric.l_sq[own.origin]))
    return glued(metric.mesh.faces[own.origin], lengths, own.origin, metric.mesh.n_vertices)


@memoized
def corners(metric: Metric) -> marching.Corners:
    """The corners of the triangulation, grouped by vertex."""
    grid = triangulation(metric)
    n = metric.mesh.n_vertices
    start, order, ends, shape = (
        _embedded_corners(metric.mesh) if metric.conformal_factor is not None else _corners(grid, n)
    )
    speed = np.ones(n) if metric.conformal_factor is None else np.sqrt(metric.conformal_factor)
    slowness = speed[grid.faces].mean(axis=1)[order // 3]
    return marching.Corners(start, ends, shape, slowness, np.stack([grid.whole, speed], axis=1))


@memoized
def _embedded_corners(mesh: Mesh) -> tuple[Integers, Integers, Integers, Floats]:
    """The part of `corners` that all conformal metrics share."""
    return _corners(glued_delaunay(mesh), mesh.n_vertices)


def _corners(grid: GluedTriangulation, n: int) -> tuple[Integers, Integers, Integers, Floats]:
    """First row of each vertex (n + 1,), corner 3 * face + k of each row, ends (3 m, 2) and shape (3 m, 8)."""
    order = np.argsort(grid.faces.ravel(), kind="stable")
    start = np.append(0, np.cumsum(np.bincount(grid.faces.ravel(), minlength=n)))
    angle, to_next = angles(grid.lengths**2), grid.lengths[:, [2, 0, 1]]
    to_previous = grid.lengths[:, [1, 2, 0]]
    leaving, arriving = grid.direction, wrapped(grid.direction + angle, grid.whole[grid.faces])
    columns = [to_next, to_previous, np.cos(angle), np.sin(angle), leaving, arriving]
    columns += [arriving[:, [1, 2, 0]], leaving[:, [2, 0, 1]]]  # the edges back from next and previous
    shape = np.stack([c.ravel()[order] for c in columns], axis=1)
    ends = np.stack([grid.faces[:, [1, 2, 0]].ravel()[order], grid.faces[:, [2, 0, 1]].ravel()[order]], axis=1)
    return start, order, np.ascontiguousarray(ends), np.ascontiguousarray(shape)


def seeds(metric: Metric, points: SurfacePoints) -> Seeds:
    """Straight lines from the points to the corners of the triangle of the triangulation they lie in."""
    row = _row_of_face(metric.mesh)[points.face]
    own = glued_faces(metric.mesh)
    known = row >= 0
    weights = points.barycentric.copy()
    turned = known & (own.faces[row, 1] != metric.mesh.faces[points.face, 1])
    weights[turned] = weights[turned][:, [0, 2, 1]]
    grid = triangulation(metric)
    vertices = np.where(known[:, None], own.faces[row], metric.mesh.faces[points.face])
    lengths = np.where(
        known[:, None], own.lengths[row] if metric.conformal_factor is not None else grid.lengths[row], 0.0
    )
    lost = ~known
    lengths[lost] = np.sqrt(metric.l_sq[points.face[lost]])
    distance, angle = _spokes(lengths, weights)
    direction = np.where(known[:, None], own.direction[row] + angle, np.nan)
    if metric.conformal_factor is not None:
        moved = np.flatnonzero(known & (grid.faces[row] != own.faces[row]).any(axis=1))
        place, inner = _located(metric, vertices[moved], weights[moved], distance[moved], direction[moved])
        found = place >= 0
        moved, place = moved[found], place[found]
        vertices[moved] = grid.faces[place]
        distance[moved], angle = _spokes(grid.lengths[place], inner[found])
        direction[moved] = grid.direction[place] + angle
        speed = np.sqrt(metric.conformal_factor)[vertices].mean(axis=1, keepdims=True)
        distance = distance * np.where(known[:, None], speed, 1.0)
    direction = wrapped(direction, grid.whole[vertices])
    at = weights.max(axis=1) >= 1.0
    return _at_vertices(Seeds(vertices, distance, direction), np.flatnonzero(at), points)


def _at_vertices(found: Seeds, which: Integers, points: SurfacePoints) -> Seeds:
    """Points that are vertices: one seed at distance zero."""
    found.vertices[which, 0] = points.nearest_vertices()[which]
    found.distances[which] = [0.0, np.inf, np.inf]
    found.directions[which] = np.nan
    return found


def _located(
    metric: Metric, vertices: Integers, weights: Floats, distance: Floats, direction: Floats
) -> tuple[Integers, Floats]:
    """Rows of the Delaunay triangulation and weights of points given in triangles that are no longer there."""
    grid, pick = glued_delaunay(metric.mesh), weights.argmax(axis=1)[:, None]
    start, order, _, _ = _embedded_corners(metric.mesh)
    columns = [np.take_along_axis(a, pick, 1)[:, 0] for a in (vertices.astype(float), direction, distance)]
    rays = np.ascontiguousarray(np.stack(columns, axis=1))
    return locating.locate(start, order, grid.lengths, grid.twin, grid.direction, grid.whole, rays)


def _spokes(lengths: Floats, weights: Floats) -> tuple[Floats, Floats]:
    """Length (p, 3) of the line from each corner to the point, and its angle from the edge to the next corner."""
    angle = angles(lengths**2)
    ahead = lengths[:, [2, 0, 1]] * weights[:, [1, 2, 0]]
    back = lengths[:, [1, 2, 0]] * weights[:, [2, 0, 1]]
    x, y = ahead + back * np.cos(angle), back * np.sin(angle)
    return np.hypot(x, y), np.arctan2(y, x)


@memoized
def _row_of_face(mesh: Mesh) -> Integers:
    """The row of each mesh face in the triangulation, -1 for faces left out."""
    row = np.full(mesh.n_faces, -1, dtype=np.int64)
    origin = glued_faces(mesh).origin
    row[origin] = np.arange(len(origin))
    return row


def fresh_front(n: int) -> marching.Front:
    """A front that has reached nothing."""
    state = np.full((n, 3), np.inf)
    whole = [np.full(n, marching.UNSEEN), np.empty(n, np.int64), np.empty(n, np.int64), np.zeros(n, np.int64)]
    return marching.Front(state, *whole, np.zeros(2, np.int64))
