"""From placed samples to every vertex, and the closest points that takes."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, bumpy, permuted, surface
from numpy.typing import NDArray

from geodesics import Mesh, SurfacePoints
from gmds._kernels.closest import closest_on_faces
from gmds.deformations import remeshing
from gmds.spectral.extension import closest_points, extend
from gmds.surface.measured import measure

Array = NDArray[np.float64]


def on_segment(x: Array, a: Array, b: Array) -> Array:
    length = (b - a) @ (b - a)
    return a + np.clip((x - a) @ (b - a) / length if length > 0 else 0.0, 0, 1) * (b - a)


def squared_distance(x: Array, triangle: Array) -> float:
    """Naive: the foot on the plane by least squares if it is inside, else the nearest point of the three sides."""
    a, b, c = triangle
    e = np.stack([b - a, c - a], axis=1)
    u, v = np.linalg.lstsq(e, x - a, rcond=None)[0]
    points = [on_segment(x, p, q) for p, q in ((a, b), (b, c), (c, a))]
    if u >= 0 and v >= 0 and u + v <= 1:
        points.append(a + e @ [u, v])
    return min(float((x - p) @ (x - p)) for p in points)


def around(faces: Array, n: int, all_of_them: bool) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The faces of each vertex, or every face for each vertex."""
    lists = [np.arange(len(faces)) if all_of_them else np.flatnonzero((faces == v).any(axis=1)) for v in range(n)]
    return np.concatenate(lists), np.concatenate([[0], np.cumsum([len(x) for x in lists])])


@pytest.mark.parametrize("dim", [2, 3, 9])
@pytest.mark.parametrize("kind", ["random", "slivers", "degenerate"])
def test_closest_points_agree_with_their_naive_twin(dim: int, kind: str) -> None:
    rng = np.random.default_rng(dim)
    rows, faces = rng.standard_normal((12, dim)), rng.permuted(np.tile(np.arange(12), (15, 1)), axis=1)[:, :3].copy()
    if kind == "slivers":
        rows[6:] = rows[:6] + 1e-4 * rng.standard_normal((6, dim))
        faces[:8] = [[i % 6, i % 6 + 6, (i + 1) % 6] for i in range(8)]
    if kind == "degenerate":
        rows[6:] = rows[:6]
        faces[:8] = [[i % 6, i % 6 + 6, (i + 1) % 6] for i in range(8)]
        faces[8] = 3
    queries = 1.5 * rng.standard_normal((40, dim))
    ring, start = around(faces, 12, all_of_them=True)
    guess = rng.integers(0, 12, 40)
    face, weight, squared = closest_on_faces(queries, rows, faces, ring, start, guess, 3)
    expected = [min(squared_distance(x, rows[f]) for f in faces) for x in queries]
    assert np.allclose(squared, expected, rtol=1e-6, atol=1e-7)
    assert np.allclose(weight.sum(axis=1), 1)
    assert (weight >= -1e-12).all()
    feet = np.einsum("pk,pkd->pd", weight, rows[faces[face]])
    assert np.allclose(((queries - feet) ** 2).sum(axis=1), squared, rtol=1e-6, atol=1e-7)


def test_the_search_walks_to_the_closest_point_of_a_round_surface() -> None:
    mesh = shapes.icosphere(2)
    rng = np.random.default_rng(0)
    queries = rng.standard_normal((60, 3))
    queries *= (rng.uniform(0.95, 1.1, 60) / np.linalg.norm(queries, axis=1))[:, None]
    ring, start = around(mesh.faces, mesh.n_vertices, all_of_them=False)
    guess = np.zeros(60, dtype=np.int64)  # from the same vertex, up to half way round
    _, _, squared = closest_on_faces(queries, mesh.vertices, mesh.faces, ring, start, guess, 60)
    expected = [min(squared_distance(x, mesh.vertices[f]) for f in mesh.faces) for x in queries]
    assert np.allclose(squared, expected, atol=1e-9)


def test_a_vertex_is_its_own_closest_point() -> None:
    view = surface(bumpy()).regular
    points = closest_points(view, view.functions, view.functions)
    assert np.allclose(points.positions, view.mesh.vertices, atol=1e-6)


def test_points_inside_faces_are_found_again() -> None:
    view = surface(bumpy()).regular
    rng = np.random.default_rng(1)
    face = rng.integers(0, view.mesh.n_faces, 50)
    inside = SurfacePoints(view.mesh, face, rng.dirichlet([2, 2, 2], 50))
    found = closest_points(view, view.functions, inside.interpolate(view.functions))
    assert np.allclose(found.positions, inside.positions, atol=1e-6)


def test_the_identity_of_the_samples_extends_to_the_identity() -> None:
    view = surface(animal()).regular
    samples = view.samples(150)
    points = extend(view, view, samples, SurfacePoints.at_vertices(view.mesh, samples), 60)
    assert np.allclose(points.positions, view.mesh.vertices, atol=1e-6)


def test_a_renumbering_of_the_samples_extends_to_all_vertices() -> None:
    mesh, place = permuted(shapes.moved(bumpy(), 1e3, seed=4))
    ours, theirs = surface(bumpy()).regular, measure(mesh).regular
    samples = ours.samples(90)
    points = extend(ours, theirs, samples, SurfacePoints.at_vertices(theirs.mesh, place[samples]), 60)
    assert np.allclose(points.positions, theirs.mesh.vertices[place], atol=1e-6)


def test_on_another_triangulation_the_extension_is_closer_than_any_vertices() -> None:
    mesh = shapes.bumpy_sphere(3)
    other, truth = remeshing(mesh, rng=1)
    source, target = measure(mesh), measure(other)
    row = np.argsort(target.face_index)  # of each face of the other mesh, all of which belong to its surface
    places = SurfacePoints(target.mesh, row[truth.face], truth.barycentric)
    assert np.array_equal(target.mesh.faces[row], other.faces)
    ours, theirs = source.regular, target.regular
    samples = ours.samples(150)
    points = extend(ours, theirs, samples, places[samples], 40)
    error = np.linalg.norm(points.positions - places.positions, axis=1).mean()
    floor = np.linalg.norm(target.mesh.vertices[places.nearest_vertices()] - places.positions, axis=1).mean()
    assert error < 0.5 * floor  # what the best of all maps from vertices to vertices leaves


def test_vertices_on_no_face_are_nobody_s_closest_point() -> None:
    mesh = measure(shapes.with_isolated(bumpy()))
    view = mesh.regular
    points = closest_points(view, view.functions, np.zeros((4, view.functions.shape[1])))
    assert np.isin(points.nearest_vertices(), view.usable).all()
    assert isinstance(points.mesh, Mesh)


@pytest.mark.parametrize("count", [12, 30, 90])
def test_few_samples_that_are_not_quite_right_do_not_tear_the_map(count: int) -> None:
    view = surface(bumpy()).regular
    places, samples = view.mesh.vertices, view.samples(count)
    noise = np.random.default_rng(2).normal(0, 0.03, (count, 3))  # of the square root of the area
    placed = SurfacePoints.closest(view.mesh, places[samples] + noise)
    points = extend(view, view, samples, placed, 60)
    assert np.linalg.norm(points.positions - places, axis=1).mean() < 0.06
    edges = points.positions[view.mesh.faces] - points.positions[np.roll(view.mesh.faces, 1, axis=1)]
    true = places[view.mesh.faces] - places[np.roll(view.mesh.faces, 1, axis=1)]
    assert (edges**2).sum() < 2 * (true**2).sum()


@pytest.mark.parametrize("count", [1, 3])
def test_hardly_any_samples_still_give_a_point_for_every_vertex(count: int) -> None:
    view = surface(bumpy()).regular
    samples = view.samples(count)
    points = extend(view, view, samples, SurfacePoints.at_vertices(view.mesh, samples), 60)
    assert len(points) == bumpy().n_vertices
    assert np.isfinite(points.positions).all()
