"""Maps made of maps: the inverse, and one after another."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics import intrinsic
from geodesics.closest import closest_on_triangles
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.correspondence import Correspondence
from gmds.errors import MapError

Array = NDArray[np.float64]

FAR = 0.05  # of sqrt(target area): the distance at which the protocol stops calling a point well matched
TORN = 5.0  # an image edge stretched more than this, and longer than 2 FAR, crosses a tear of the map


def invert(answer: Correspondence) -> Correspondence:
    """The map from target to source.

    The images of the source triangles are triangles lying along the target. Each target vertex takes the nearest
    point (in space) of the nearest of them, and that point's barycentric weights in the source triangle; a vertex
    map that is one to one is therefore inverted exactly. Triangles with a corner that is not valid, or torn apart by
    the map (an edge stretched more than 5 times and longer than 0.1 sqrt(area)), are left out. A vertex is not
    `valid` when the nearest image is further than 0.05 sqrt(target area), or when it is on no face.
    Distortion is that of the source point plus the distance to the image over sqrt(target area); candidates are
    dropped.
    """
    source, target = answer.source, answer.target
    points, gap = preimage(answer, np.arange(target.n_vertices))
    valid = (gap <= FAR) & (np.bincount(target.faces.ravel(), minlength=target.n_vertices) > 0)
    distortion = np.where(np.isfinite(gap), points.interpolate(answer.distortion) + gap, 1.0)
    return Correspondence(target, source, points, valid, distortion, answer.status, (), answer.meta)


def preimage(answer: Correspondence, vertices: ArrayLike) -> tuple[SurfacePoints, Array]:
    """Where target vertices (p,) come from, as `invert` has it, and their distance (p,) from the nearest image.

    The distance is over sqrt(target area), infinite where nothing has an image.
    """
    source, target = answer.source, answer.target
    image, size = answer.points.positions, np.sqrt(target.area)
    queries = target.vertices[np.asarray(vertices, dtype=np.int64)]
    usable = np.flatnonzero(answer.valid[source.faces].all(axis=1) & ~_torn(source, image, size))
    if len(usable) == 0:
        nowhere = SurfacePoints(
            source, np.zeros(len(queries), dtype=np.int64), np.tile(np.eye(3)[0], (len(queries), 1))
        )
        return nowhere, np.full(len(queries), np.inf)
    face, weights, gap = closest_on_triangles(queries, image, source.faces[usable])
    return SurfacePoints(source, usable[face], weights), gap / size


def compose(first: Correspondence, second: Correspondence) -> Correspondence:
    """The map that sends a source vertex through `first`, and its point through `second` (see `image`).

    A row is `valid` when `first` is there and `second` is at every corner with weight; distortions add.
    Raises `MapError` when `second` does not start on the mesh where `first` ends.
    """
    if first.target is not second.source:
        raise MapError("the second map must start on the very mesh (the same object) on which the first one ends")
    points, valid, distortion = image(second, first.points)
    status = max(first.status, second.status, key=lambda status: status.rank)
    return Correspondence(
        first.source, second.target, points, first.valid & valid, first.distortion + distortion, status
    )


def image(answer: Correspondence, points: SurfacePoints) -> tuple[SurfacePoints, NDArray[np.bool_], Array]:
    """Where a map sends points (p) of its source, anywhere on the faces; `valid` (p,) and `distortion` (p,) there.

    The three corners of the face a point lies on have images. When these lie on one face, or the point is a corner,
    the image follows exactly; else it is the surface point nearest to their weighted mean. Where the map tears the
    face (as in `invert`) the heaviest corner decides. A point is `valid` when every corner with weight is; distortion
    is interpolated. Raises `MapError` when the points lie on another mesh.
    """
    if points.mesh is not answer.source:
        raise MapError("the points must lie on the very mesh (the same object) on which the map starts")
    corners = answer.source.faces[points.face]
    weights = points.barycentric
    rows = np.arange(len(corners))
    heaviest = answer.points[corners[rows, weights.argmax(axis=1)]]
    corner_face, corner_weights = answer.points.face[corners], answer.points.barycentric[corners]
    position = answer.points.positions[corners]

    face, barycentric = heaviest.face.copy(), heaviest.barycentric.copy()
    inside = weights.max(axis=1) < 1 - 1e-12
    same = inside & (corner_face == corner_face[:, :1]).all(axis=1)
    face[same] = corner_face[same, 0]
    barycentric[same] = np.einsum("pk,pkj->pj", weights[same], corner_weights[same])
    torn = _torn(answer.source, answer.points.positions, np.sqrt(answer.target.area))[points.face]
    mixed = np.flatnonzero(inside & ~same & ~torn)
    if len(mixed):
        mean = np.einsum("pk,pkj->pj", weights[mixed], position[mixed])
        face[mixed], barycentric[mixed], _ = closest_on_triangles(mean, answer.target.vertices, answer.target.faces)

    valid = np.all(answer.valid[corners] | (weights <= 0), axis=1)
    return SurfacePoints(answer.target, face, barycentric), valid, points.interpolate(answer.distortion)


def _torn(source: Mesh, image: Array, size: float) -> NDArray[np.bool_]:
    """Source faces (m,) with an edge that the map stretches beyond reason; size is sqrt(target area)."""
    before = np.sqrt(intrinsic.squared_lengths(source.vertices, source.faces)) * size / np.sqrt(source.area)
    after = np.sqrt(intrinsic.squared_lengths(image, source.faces))
    return ((after > TORN * before) & (after > 2 * FAR * size)).any(axis=1)
