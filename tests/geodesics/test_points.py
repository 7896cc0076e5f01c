"""SurfacePoints: checked weights, positions, interpolation, closest points."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere, tetrahedron, with_isolated
from hypothesis import given, settings
from hypothesis import strategies as st

from geodesics import MeshError, SurfacePoints

MESH = bumpy_sphere(1)


def some_points(seed: int = 0, count: int = 20) -> SurfacePoints:
    rng = np.random.default_rng(seed)
    return SurfacePoints(MESH, rng.integers(0, MESH.n_faces, count), rng.dirichlet(np.ones(3), count))


REFUSED: list[tuple[str, Any, Any, str]] = [
    ("E105", [0, MESH.n_faces], [[1, 0, 0]] * 2, "point 1"),
    ("E105", [-1], [[1, 0, 0]], "point 0"),
    ("E106", [0.5], [[1, 0, 0]], "point 0"),
    ("E107", ["a"], [[1, 0, 0]], "whole numbers"),
    ("E108", [0, 1], [[1, 0, 0]], "(2, 3)"),
    ("E108", [[0]], [[1, 0, 0]], "(p,)"),
    ("E108", [0], [[1, 0]], "(1, 3)"),
    ("E108", [0], [], "(1, 3)"),
    ("E108", [], [[1, 0, 0]], "(0, 3)"),
    ("E107", [0], [[True, False, False]], "real numbers"),
    ("E115", [0, 1], [[1, 0, 0], [np.nan, 0, 1]], "point 1"),
    ("E115", [0, 1], [[1, 0, 0], [np.inf, 0, 1]], "point 1"),
    ("E115", [0], [[1.5, -0.5, 0]], "point 0"),
    ("E115", [0], [[0.5, 0.4, 0]], "sum to 1"),
    ("E115", [0], [[0, 0, 0]], "sum to 1"),
    ("E115", [0], [[1e308, 1e308, 0]], "sum to 1"),
]


@pytest.mark.parametrize(("code", "face", "weights", "says"), REFUSED)
def test_bad_points_are_refused(code: str, face: Any, weights: Any, says: str) -> None:
    with pytest.raises(MeshError) as caught:
        SurfacePoints(MESH, face, weights)
    assert caught.value.code == code and says in str(caught.value)


def test_only_a_mesh_carries_points() -> None:
    with pytest.raises(TypeError, match="Mesh"):
        SurfacePoints("sphere", [0], [[1, 0, 0]])  # type: ignore[arg-type]


def test_rounding_is_removed_and_checking_twice_changes_nothing() -> None:
    loose = SurfacePoints(MESH, [0, 1], [[1 + 1e-9, -1e-9, 0], [0.3, 0.3, 0.4 + 1e-8]])
    assert (loose.barycentric >= 0).all()
    assert np.abs(loose.barycentric.sum(axis=1) - 1).max() < 1e-15
    again = SurfacePoints(MESH, loose.face, loose.barycentric)
    assert again.barycentric.tobytes() == loose.barycentric.tobytes()


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**31))
def test_sound_weights_pass_bit_for_bit_when_taken_again(seed: int) -> None:
    points = some_points(seed)
    assert points[np.arange(len(points))].barycentric.tobytes() == points.barycentric.tobytes()


def test_positions_at_vertices_are_the_vertices() -> None:
    index = np.array([5, 0, 7])
    points = SurfacePoints.at_vertices(MESH, index)
    assert np.array_equal(points.positions, MESH.vertices[index])
    assert np.array_equal(points.nearest_vertices(), index)
    assert len(SurfacePoints.at_vertices(MESH, [])) == 0 and SurfacePoints(MESH, [], []).barycentric.shape == (0, 3)
    assert len(SurfacePoints.at_vertices(MESH, 3)) == 1


def test_at_vertices_refuses_what_is_no_point_of_the_surface() -> None:
    lonely = with_isolated(icosphere(1))
    used = np.zeros(lonely.n_vertices, dtype=bool)
    used[lonely.faces] = True
    with pytest.raises(MeshError, match="on no face"):
        SurfacePoints.at_vertices(lonely, np.flatnonzero(~used)[:1])
    for wrong in ([MESH.n_vertices], [-1]):
        with pytest.raises(MeshError, match="E105"):
            SurfacePoints.at_vertices(MESH, wrong)


def test_interpolation_reproduces_linear_functions() -> None:
    points = some_points()
    slope = np.array([0.3, -2.0, 1.0])
    assert np.allclose(points.interpolate(MESH.vertices @ slope + 4), points.positions @ slope + 4, atol=1e-12)
    assert points.interpolate(MESH.vertices).shape == (20, 3)
    with pytest.raises(MeshError, match="one row per vertex"):
        points.interpolate(np.zeros(3))


def test_taking_some_of_the_points() -> None:
    points = some_points()
    assert np.array_equal(points[3:7].positions, points.positions[3:7])
    assert np.array_equal(points[points.face % 2 == 0].face, points.face[points.face % 2 == 0])
    assert len(points[[]]) == 0 and len(points[4]) == 1
    with pytest.raises(IndexError):
        points[20]


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
def test_closest_points_of_points_on_the_surface_are_themselves(scale: float) -> None:
    from geodesics import Mesh

    mesh = Mesh(scale * MESH.vertices, MESH.faces)
    found = SurfacePoints.closest(mesh, scale * some_points().positions)
    assert np.abs(found.positions / scale - some_points().positions).max() < 1e-12


def test_closest_point_beats_a_fine_sample() -> None:
    rng = np.random.default_rng(3)
    mesh, queries = tetrahedron(), rng.normal(size=(30, 3)) * 2
    found = SurfacePoints.closest(mesh, queries)
    sample = SurfacePoints(mesh, rng.integers(0, 4, 4000), rng.dirichlet(np.ones(3), 4000)).positions
    best = np.linalg.norm(queries[:, None] - sample, axis=2).min(axis=1)
    distance = np.linalg.norm(found.positions - queries, axis=1)
    assert (distance <= best + 1e-12).all() and (distance >= best - 0.2).all()
