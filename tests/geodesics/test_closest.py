"""The point of a triangle nearest to a point in space, against a dense search."""

from __future__ import annotations

import numpy as np

from geodesics.closest import closest_on_triangles, closest_weights

RNG = np.random.default_rng(5)


def test_closest_weights_against_a_dense_search() -> None:
    """Random triangles, and flat ones of every kind: two equal corners, three in a row, all equal."""
    triangles = RNG.standard_normal((60, 3, 3))
    triangles[40:45, 1] = triangles[40:45, 0]
    triangles[45:50, 2] = triangles[45:50, 1]
    triangles[50:55, 2] = 2 * triangles[50:55, 1] - triangles[50:55, 0]
    triangles[55:] = triangles[55:, :1]
    queries = RNG.standard_normal((60, 3)) * 2
    weights = closest_weights(queries, triangles)
    assert (weights >= 0).all()
    np.testing.assert_allclose(weights.sum(axis=1), 1)
    i, j = np.triu_indices(81)
    dense = np.stack([i, j - i, 80 - j], axis=1) / 80
    best = np.linalg.norm(np.einsum("dk,pkj->pdj", dense, triangles) - queries[:, None], axis=2).min(axis=1)
    found = np.linalg.norm(np.einsum("pk,pkj->pj", weights, triangles) - queries, axis=1)
    assert (found <= best + 1e-9).all()
    assert (found >= best - 0.05).all()


def test_degenerate_triangles_do_not_lose_queries() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5.0]])
    faces = np.array([[0, 0, 1], [3, 3, 3], [0, 1, 2]])
    queries = RNG.standard_normal((200, 3)) * 3
    _, weights, gap = closest_on_triangles(queries, vertices, faces)
    assert np.isfinite(weights).all()
    clipped = closest_weights(queries, np.tile(vertices[[0, 1, 2]], (200, 1, 1)))
    at_face = np.linalg.norm(np.einsum("pk,kj->pj", clipped, vertices[:3]) - queries, axis=1)
    np.testing.assert_allclose(gap, np.minimum(at_face, np.linalg.norm(queries - 5, axis=1)), atol=1e-9)
