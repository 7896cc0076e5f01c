"""Where a map sends points of its source, and where points of its target come from."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics import intrinsic
from geodesics.arrays import Bools, Floats
from geodesics.barycentric import combination
from geodesics.closest import closest_on_triangles
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.errors import MapError
from gmds.maps.point_map import PointMap

FAR = 0.05  # of sqrt(target area): the distance at which the protocol stops calling a point well matched
# Spacings of vertices: 0.75 and 1 keep what the image of a part reaches, on the PFAUST pairs of the development half.
COVERED = 0.75
TORN = 5.0  # an image edge stretched more than this, and longer than 2 FAR, crosses a tear of the map; set by hand


def preimage(answer: PointMap, vertices: ArrayLike) -> tuple[SurfacePoints, Floats]:
    """Where target vertices (p,) come from, as `invert` has it, and their distance (p,) from the nearest image.

    The distance is over sqrt(target area), infinite where nothing has an image.
    """
    source, target = answer.source, answer.target
    image, size = answer.points.positions, np.sqrt(target.area)
    queries = target.vertices[np.asarray(vertices, dtype=np.int64)]
    usable = np.flatnonzero(answer.valid[source.faces].all(axis=1) & ~torn_faces(source, image, size))
    if len(usable) == 0:
        nowhere = SurfacePoints(
            source, np.zeros(len(queries), dtype=np.int64), np.tile(np.eye(3)[0], (len(queries), 1))
        )
        return nowhere, np.full(len(queries), np.inf)
    face, weights, gap = closest_on_triangles(queries, image, source.faces[usable])
    return SurfacePoints(source, usable[face], weights), gap / size


def image(answer: PointMap, points: SurfacePoints) -> tuple[SurfacePoints, Bools, Floats]:
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
    barycentric[same] = combination(weights[same], corner_weights[same])
    torn = torn_faces(answer.source, answer.points.positions, np.sqrt(answer.target.area))[points.face]
    mixed = np.flatnonzero(inside & ~same & ~torn)
    if len(mixed):
        mean = combination(weights[mixed], position[mixed])
        face[mixed], barycentric[mixed], _ = closest_on_triangles(mean, answer.target.vertices, answer.target.faces)

    valid = np.all(answer.valid[corners] | (weights <= 0), axis=1)
    return SurfacePoints(answer.target, face, barycentric), valid, points.interpolate(answer.distortion)


def inverted(answer: PointMap) -> dict[str, Any]:
    """The rows of the map from target to source, by name: see `Correspondence.inverse`."""
    target = answer.target
    points, gap = preimage(answer, np.arange(target.n_vertices))
    return {
        "points": points,
        "valid": (gap <= FAR) & (np.bincount(target.faces.ravel(), minlength=target.n_vertices) > 0),
        "distortion": np.where(np.isfinite(gap), points.interpolate(answer.distortion) + gap, 1.0),
        "confidence": confidence_between(points, answer.confidence),
    }


def composed(first: PointMap, second: PointMap) -> dict[str, Any]:
    """The rows of the map that goes on with `second`, by name: see `Correspondence.compose`."""
    points, valid, distortion = image(second, first.points)
    return {
        "points": points,
        "valid": first.valid & valid,
        "distortion": first.distortion + distortion,
        "confidence": first.confidence * confidence_between(first.points, second.confidence),
    }


def confidence_between(points: SurfacePoints, confidence: Floats) -> Floats:
    """Probabilities at points, from those at vertices: weights sum to 1 only up to rounding. NaN stays NaN."""
    return np.asarray(np.clip(points.interpolate(confidence), 0.0, 1.0), dtype=np.float64)


def torn_faces(source: Mesh, image: Floats, size: float) -> Bools:
    """Source faces (m,) with an edge that the map stretches beyond reason; size is sqrt(target area)."""
    before = np.sqrt(intrinsic.squared_lengths(source.vertices, source.faces)) * size / np.sqrt(source.area)
    after = np.sqrt(intrinsic.squared_lengths(image, source.faces))
    return ((after > TORN * before) & (after > 2 * FAR * size)).any(axis=1)
