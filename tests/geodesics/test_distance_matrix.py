"""Distances among points: rows of fields at vertices, symmetric inside faces, infinite between components."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere

import geodesics
from geodesics import Mesh, SurfacePoints, distance_matrix

MESH = bumpy_sphere(2)
SPECTRUM = geodesics.eigenpairs(MESH, 30)
DISTANCES = [
    geodesics.GeodesicDistance(MESH),
    geodesics.CommuteTimeDistance(SPECTRUM),
    geodesics.DiffusionDistance(SPECTRUM, 0.05),
]
each_distance = pytest.mark.parametrize("distance", DISTANCES, ids=lambda d: type(d).__name__)


def inner_points(count: int) -> SurfacePoints:
    rng = np.random.default_rng(3)
    return SurfacePoints(MESH, rng.integers(0, MESH.n_faces, count), rng.dirichlet(np.ones(3), count))


@each_distance
def test_at_vertices_it_holds_rows_of_fields(distance: Any) -> None:
    here, there = [3, 50, 7], [9, 3]
    expected = distance.field(here)[:, there]
    np.testing.assert_allclose(distance_matrix(distance, here, there), expected, atol=1e-12)


@each_distance
def test_it_is_a_semimetric(distance: Any) -> None:
    d = distance_matrix(distance, inner_points(12))
    assert np.array_equal(d, d.T) and not d.diagonal().any() and (d[~np.eye(12, dtype=bool)] > 0).all()
    excess = d[:, :, None] - d[:, None, :] - d[None]
    assert excess.max() < 0.05 * d.max()  # the triangle inequality, up to interpolation


def test_spectral_distances_are_exact_inside_faces() -> None:
    distance, points = DISTANCES[1], inner_points(5)
    rows = points.interpolate(distance.embedding)  # type: ignore[attr-defined]
    expected = np.linalg.norm(rows[:, None] - rows, axis=2)
    np.testing.assert_allclose(distance_matrix(distance, points), expected, atol=1e-12)


@pytest.mark.parametrize("kind", [geodesics.GeodesicDistance, geodesics.CommuteTimeDistance])
def test_components_are_infinitely_far_apart(kind: Any) -> None:
    n = MESH.n_vertices
    both = Mesh(np.vstack([MESH.vertices, MESH.vertices + 9]), np.vstack([MESH.faces, MESH.faces + n]))
    d = distance_matrix(kind(both), [0, 5, n, n + 5])
    assert np.isinf(d[:2, 2:]).all() and np.isfinite(d[:2, :2]).all()
    np.testing.assert_allclose(d[:2, :2], d[2:, 2:], rtol=1e-6)


def test_a_mesh_is_no_distance() -> None:
    with pytest.raises(TypeError, match="a distance is expected, not Mesh"):
        distance_matrix(MESH, [0])  # type: ignore[arg-type]


def test_no_module_hides_a_public_name() -> None:
    """A module of the name of a function would take its place once anybody imported it."""
    import importlib.util

    import geodesics
    import gmds

    for package in (geodesics, gmds):
        for name in package.__all__:
            hidden = importlib.util.find_spec(f"{package.__name__}.{name}")
            assert hidden is None, f"{package.__name__}.{name}"
