"""Where a front starts: the vertices around a point, with exact distances and directions back to it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geodesics._kernels import locating
from geodesics.arrays import Floats, Integers
from geodesics.caching import memoized
from geodesics.delaunay import GluedTriangulation, glued_faces, wrapped
from geodesics.fast_marching.front import rows, speeds, triangulation
from geodesics.intrinsic import angles
from geodesics.mesh import Mesh
from geodesics.metric import Metric
from geodesics.points import SurfacePoints


class Seeds(NamedTuple):
    """For each of p points the vertices (p, 3) around it, and from each distance and direction (p, 3, 2) back to it."""

    vertices: Integers
    spokes: Floats


def seeds(metric: Metric, points: SurfacePoints) -> Seeds:
    """Straight lines to the points from the corners of the triangle that they lie in, of the triangulation marched.

    A point that is a vertex has this one seed, at distance zero. A point on a face that the triangulation leaves out
    (one that names a vertex twice) is taken straight to the corners of that face.
    """
    own, grid = glued_faces(metric.mesh), triangulation(metric)
    row = _row_of_face(metric.mesh)[points.face]
    vertices, weights = metric.mesh.faces[points.face], points.barycentric.copy()
    turned = (row >= 0) & (own.faces[row, 1] != vertices[:, 1])
    vertices[turned], weights[turned] = vertices[turned][:, [0, 2, 1]], weights[turned][:, [0, 2, 1]]
    row, weights = _followed(metric, row, vertices, weights)
    kept = row >= 0
    vertices[kept] = grid.faces[row[kept]]
    spokes = np.full((len(points), 3, 2), np.nan)
    spokes[kept] = _spokes(grid, row[kept], weights[kept])
    spokes[~kept, :, 0] = _straight(metric, points[np.flatnonzero(~kept)])
    if metric.conformal_factor is not None:
        spokes[kept, :, 0] *= speeds(metric)[vertices[kept]].mean(axis=1, keepdims=True)
    whole = np.flatnonzero(points.barycentric.max(axis=1) >= 1.0)
    vertices[whole, 0] = points.nearest_vertices()[whole]
    spokes[whole, :, 0] = [0.0, np.inf, np.inf]
    spokes[whole, :, 1] = np.nan
    return Seeds(vertices, spokes)


def _followed(metric: Metric, row: Integers, vertices: Integers, weights: Floats) -> tuple[Integers, Floats]:
    """Row and weights in the triangulation marched over, after edge flips; row -1 where the point was not located."""
    own, grid = glued_faces(metric.mesh), triangulation(metric)
    moved = np.flatnonzero((row >= 0) & (grid.faces[row] != vertices).any(axis=1))
    if len(moved) == 0 or metric.conformal_factor is None:
        return row, weights
    row, weights = row.copy(), weights.copy()
    nearest = weights[moved].argmax(axis=1)
    spokes = _spokes(own, row[moved], weights[moved])[np.arange(len(moved)), nearest]
    rays = np.column_stack([vertices[moved, nearest], spokes[:, 1], spokes[:, 0]])
    start, order, _, _ = rows(metric)
    net = locating.Net(start, order, grid.lengths, grid.twin, grid.direction, grid.whole)
    row[moved], weights[moved] = locating.locate(net, rays)
    return row, weights


def _spokes(grid: GluedTriangulation, row: Integers, weights: Floats) -> Floats:
    """From each corner of the rows (p,) the length and direction (p, 3, 2) of the straight line to the point."""
    lengths = grid.lengths[row]
    angle = angles(lengths**2)
    ahead = lengths[:, [2, 0, 1]] * weights[:, [1, 2, 0]]
    back = lengths[:, [1, 2, 0]] * weights[:, [2, 0, 1]]
    x, y = ahead + back * np.cos(angle), back * np.sin(angle)
    direction = wrapped(grid.direction[row] + np.arctan2(y, x), grid.whole[grid.faces[row]])
    return np.stack([np.hypot(x, y), direction], axis=2)


def _straight(metric: Metric, points: SurfacePoints) -> Floats:
    """Distances (p, 3) in space to the corners of the point's own face, scaled to the metric."""
    corners = metric.mesh.faces[points.face]
    across = points.positions[:, None] - metric.mesh.vertices[corners]
    return np.linalg.norm(across, axis=2) * speeds(metric)[corners].mean(axis=1, keepdims=True)


@memoized
def _row_of_face(mesh: Mesh) -> Integers:
    """The row of each mesh face (m,) in its triangulation, -1 for faces left out."""
    row = np.full(mesh.n_faces, -1, dtype=np.int64)
    origin = glued_faces(mesh).origin
    row[origin] = np.arange(len(origin))
    return row
