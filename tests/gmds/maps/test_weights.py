"""Weights of bones along a map: rows sum to 1, or are 0 where nothing holds the place."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import icosphere, with_isolated

from geodesics import SurfacePoints
from gmds.errors import MapError
from gmds.maps.values import carry_weights

MESH = icosphere(1)
RNG = np.random.default_rng(0)


def at(mesh: object = MESH, n: int = 200) -> SurfacePoints:
    weights = RNG.dirichlet(np.ones(3), n)
    return SurfacePoints(mesh, RNG.integers(0, mesh.n_faces, n), weights)  # type: ignore[attr-defined, arg-type]


def test_rows_sum_to_one_or_to_nothing() -> None:
    given = RNG.random((MESH.n_vertices, 5)) * 7
    given[:20] = 0
    points = at()
    held = (points.barycentric * (MESH.faces[points.face] >= 20)).sum(axis=1)
    carried = carry_weights(points, given)
    assert np.allclose(carried.sum(axis=1), held >= 0.5)


def test_vertices_on_no_face_do_not_count() -> None:
    mesh = with_isolated(MESH)
    loose = np.setdiff1d(np.arange(mesh.n_vertices), mesh.faces)
    given = np.ones((mesh.n_vertices, 3))
    given[loose] = [np.nan, -1, 0]
    assert np.allclose(carry_weights(at(mesh), given), 1 / 3)
    for wrong in (np.nan, -1.0, np.inf):
        given[mesh.faces[0, 0], 1] = wrong
        with pytest.raises(MapError, match=f"weights of vertex {mesh.faces[0, 0]} must be finite"):
            carry_weights(at(mesh), given)


@pytest.mark.parametrize("most", [1, 4, 9])
def test_the_heaviest_are_kept(most: int) -> None:
    given, points = RNG.random((MESH.n_vertices, 6)), SurfacePoints.at_vertices(MESH, np.arange(MESH.n_vertices))
    whole, few = carry_weights(points, given), carry_weights(points, given, most=most)
    kept = few > 0
    assert (kept.sum(axis=1) == min(most, 6)).all() and np.allclose(few.sum(axis=1), 1)
    assert (np.where(kept, whole, np.inf).min(axis=1) >= np.where(kept, -1, whole).max(axis=1)).all()
    assert np.allclose(few, whole * kept / (whole * kept).sum(axis=1, keepdims=True))


def test_a_row_for_every_vertex() -> None:
    with pytest.raises(MapError, match="41 rows"):
        carry_weights(at(), np.ones((41, 2)))
    with pytest.raises(MapError, match="shape"):
        carry_weights(at(), np.ones(42))
