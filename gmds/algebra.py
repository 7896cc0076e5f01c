"""Maps made of maps: the inverse, and one after another."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics import intrinsic
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.correspondence import Correspondence
from gmds.errors import MapError

Array = NDArray[np.float64]
Faces = NDArray[np.int64]

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
    image, size = answer.points.positions, np.sqrt(_area(target))
    usable = np.flatnonzero(answer.valid[source.faces].all(axis=1) & ~_torn(source, image, size))
    if len(usable) == 0:
        points = SurfacePoints(
            source, np.zeros(target.n_vertices, dtype=np.int64), np.eye(3)[np.zeros(target.n_vertices, int)]
        )
        none = np.zeros(target.n_vertices, dtype=bool)
        return Correspondence(target, source, points, none, np.ones(target.n_vertices), answer.status, (), answer.meta)
    face, weights, gap = closest_on_triangles(target.vertices, image, source.faces[usable])
    points = SurfacePoints(source, usable[face], weights)
    valid = (gap <= FAR * size) & (np.bincount(target.faces.ravel(), minlength=target.n_vertices) > 0)
    distortion = points.interpolate(answer.distortion) + gap / size
    return Correspondence(target, source, points, valid, distortion, answer.status, (), answer.meta)


def compose(first: Correspondence, second: Correspondence) -> Correspondence:
    """The map that sends a source vertex through `first`, and its point through `second`.

    The three corners of the face a point lies on have images under `second`. When these lie on one face, or the point
    is a corner, the image follows exactly; else it is the surface point nearest to their weighted mean. Where `second`
    tears the face (as in `invert`) the heaviest corner decides.
    A row is `valid` when `first` is there and `second` is at every corner with weight; distortions add.
    Raises `MapError` when `second` does not start on the mesh where `first` ends.
    """
    if first.target is not second.source:
        raise MapError("the second map must start on the very mesh (the same object) on which the first one ends")
    corners = first.target.faces[first.points.face]
    weights = first.points.barycentric
    rows = np.arange(len(corners))
    heaviest = second.points[corners[rows, weights.argmax(axis=1)]]
    corner_face, corner_weights = second.points.face[corners], second.points.barycentric[corners]
    position = second.points.positions[corners]

    face, barycentric = heaviest.face.copy(), heaviest.barycentric.copy()
    inside = weights.max(axis=1) < 1 - 1e-12
    same = inside & (corner_face == corner_face[:, :1]).all(axis=1)
    face[same] = corner_face[same, 0]
    barycentric[same] = np.einsum("pk,pkj->pj", weights[same], corner_weights[same])
    torn = _torn(second.source, second.points.positions, np.sqrt(_area(second.target)))[first.points.face]
    mixed = np.flatnonzero(inside & ~same & ~torn)
    if len(mixed):
        mean = np.einsum("pk,pkj->pj", weights[mixed], position[mixed])
        face[mixed], barycentric[mixed], _ = closest_on_triangles(mean, second.target.vertices, second.target.faces)

    valid = first.valid & (second.valid[corners] | (weights <= 0)).all(axis=1)
    distortion = first.distortion + first.points.interpolate(second.distortion)
    status = max(first.status, second.status, key=lambda status: status.rank)
    points = SurfacePoints(second.target, face, barycentric)
    return Correspondence(first.source, second.target, points, valid, distortion, status)


def closest_on_triangles(queries: Array, vertices: Array, faces: Faces) -> tuple[Faces, Array, Array]:
    """For each query (p, 3) the nearest triangle (p,), the weights of its nearest point (p, 3), the distance (p,)."""
    import igl

    vertices = np.ascontiguousarray(vertices)
    _, face, _ = igl.point_mesh_squared_distance(np.ascontiguousarray(queries), vertices, np.ascontiguousarray(faces))
    face = np.asarray(face, dtype=np.int64).reshape(-1)
    weights = closest_weights(queries, vertices[faces[face]])
    gap = np.linalg.norm(np.einsum("pk,pkj->pj", weights, vertices[faces[face]]) - queries, axis=1)
    return face, weights, gap


def closest_weights(queries: Array, triangles: Array) -> Array:
    """Weights (p, 3) of the point of triangle i (p, 3, 3) nearest to query i (p, 3); flat triangles are fine."""
    options = [_on_edge(queries, triangles, k) for k in range(3)]
    a, ab, ac = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    d00, d01, d11 = (ab * ab).sum(1), (ab * ac).sum(1), (ac * ac).sum(1)
    d20, d21 = ((queries - a) * ab).sum(1), ((queries - a) * ac).sum(1)
    det = d00 * d11 - d01**2
    flat = det <= 1e-24 * d00 * d11
    safe = np.where(flat, 1, det)
    v, w = (d11 * d20 - d01 * d21) / safe, (d00 * d21 - d01 * d20) / safe
    interior = np.stack([1 - v - w, v, w], axis=1)
    outside = flat | (interior < 0).any(axis=1)
    options.append(np.where(outside[:, None], options[0], interior))
    weights = np.stack(options)
    distance = np.linalg.norm(np.einsum("opk,pkj->opj", weights, triangles) - queries, axis=2)
    return weights[distance.argmin(axis=0), np.arange(len(queries))]


def _on_edge(queries: Array, triangles: Array, k: int) -> Array:
    """Weights of the point nearest to each query on the edge from corner k to corner k + 1."""
    start, edge = triangles[:, k], triangles[:, (k + 1) % 3] - triangles[:, k]
    length_sq = (edge * edge).sum(1)
    t = np.clip(((queries - start) * edge).sum(1) / np.where(length_sq > 0, length_sq, 1), 0, 1)
    weights = np.zeros((len(queries), 3))
    weights[:, k], weights[:, (k + 1) % 3] = 1 - t, t
    return weights


def _torn(source: Mesh, image: Array, size: float) -> NDArray[np.bool_]:
    """Source faces (m,) with an edge that the map stretches beyond reason; size is sqrt(target area)."""
    before = np.sqrt(intrinsic.squared_lengths(source.vertices, source.faces)) * size / np.sqrt(_area(source))
    after = np.sqrt(intrinsic.squared_lengths(image, source.faces))
    return ((after > TORN * before) & (after > 2 * FAR * size)).any(axis=1)


def _area(mesh: Mesh) -> float:
    return float(intrinsic.areas(intrinsic.squared_lengths(mesh.vertices, mesh.faces)).sum())
