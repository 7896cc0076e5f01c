"""Closest points on triangles in space."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.barycentric import combination


def closest_on_triangles(queries: Floats, vertices: Floats, faces: Integers) -> tuple[Integers, Floats, Floats]:
    """For each query (p, 3) the nearest triangle (p,), the weights of its nearest point (p, 3), the distance (p,)."""
    import igl

    vertices = np.ascontiguousarray(vertices)
    _, face, _ = igl.point_mesh_squared_distance(np.ascontiguousarray(queries), vertices, np.ascontiguousarray(faces))
    face = np.asarray(face, dtype=np.int64).reshape(-1)
    weights = closest_weights(queries, vertices[faces[face]])
    gap = np.linalg.norm(combination(weights, vertices[faces[face]]) - queries, axis=1)
    return face, weights, gap


def closest_weights(queries: Floats, triangles: Floats) -> Floats:
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


def _on_edge(queries: Floats, triangles: Floats, k: int) -> Floats:
    """Weights of the point nearest to each query on the edge from corner k to corner k + 1."""
    start, edge = triangles[:, k], triangles[:, (k + 1) % 3] - triangles[:, k]
    length_sq = (edge * edge).sum(1)
    t = np.clip(((queries - start) * edge).sum(1) / np.where(length_sq > 0, length_sq, 1), 0, 1)
    weights = np.zeros((len(queries), 3))
    weights[:, k], weights[:, (k + 1) % 3] = 1 - t, t
    return weights
