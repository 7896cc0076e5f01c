"""Walking straight across faces: straight lines on flat and unfolded surfaces, boundaries, broken meshes."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from numpy.typing import NDArray

from geodesics import Mesh, MeshError, SurfacePoints
from geodesics._kernels import tracing as kernel
from geodesics.tracing import gradient, layout, neighbours, turned_over, walk


def random_points(mesh: Mesh, count: int, seed: int = 0) -> SurfacePoints:
    rng = np.random.default_rng(seed)
    return SurfacePoints(mesh, rng.integers(mesh.n_faces, size=count), rng.dirichlet([1, 1, 1], count))


def axes(points: SurfacePoints) -> tuple[NDArray, NDArray]:
    """The axes of each point's frame in space."""
    a, b, c = points.mesh.vertices[points.mesh.faces[points.face]].transpose(1, 0, 2)
    x = (b - a) / np.linalg.norm(b - a, axis=1, keepdims=True)
    y = c - a - ((c - a) * x).sum(1, keepdims=True) * x
    return x, y / np.linalg.norm(y, axis=1, keepdims=True)


def in_frame(points: SurfacePoints, vectors: NDArray) -> NDArray:
    return np.stack([(vectors * axis).sum(1) for axis in axes(points)], axis=1)


def flat(seed: int = 0) -> Mesh:
    """A flat square of uneven triangles, corners in any order."""
    mesh, rng = shapes.rectangle(11, 9), np.random.default_rng(seed)
    v, f = mesh.vertices.copy(), mesh.faces.copy()
    inner = ((v[:, :2] > 0.01) & (v[:, :2] < 0.99)).all(axis=1)
    v[inner, :2] += rng.uniform(-0.025, 0.025, (inner.sum(), 2))
    order = np.argsort(rng.random(f.shape), axis=1)
    return Mesh(v, np.take_along_axis(f, order, axis=1))


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_walk_on_a_flat_square_is_a_straight_line(scale: float) -> None:
    square = shapes.moved(flat(), scale, seed=None)
    points = random_points(square, 300)
    rng = np.random.default_rng(1)
    end = scale * np.concatenate([rng.uniform(0, 1, (300, 2)), np.zeros((300, 1))], axis=1)
    there = walk(points, in_frame(points, end - points.positions))
    np.testing.assert_allclose(there.positions, end, atol=1e-12 * scale)


def test_a_walk_slides_along_the_boundary() -> None:
    square = flat()
    points = random_points(square, 200)
    beyond = points.positions + np.random.default_rng(2).uniform(-1.5, 1.5, (200, 3)) * [1, 1, 0]
    there = walk(points, in_frame(points, beyond - points.positions)).positions
    crossing = (beyond[:, :2] < 0) | (beyond[:, :2] > 1)
    one = crossing.sum(axis=1) == 1  # these only meet one side and slide along it
    assert one.sum() > 20
    np.testing.assert_allclose(there[one], np.clip(beyond[one], 0, 1), atol=1e-12)


def test_a_walk_over_the_edge_of_a_cube_is_straight_on_the_unfolded_sides() -> None:
    cube = shapes.cube(4)
    on_top = np.flatnonzero((cube.vertices[cube.faces][:, :, 2] == 1).all(axis=1))
    rng = np.random.default_rng(3)
    start = SurfacePoints(cube, rng.choice(on_top, 100), rng.dirichlet([1, 1, 1], 100))
    way = np.stack([2 - start.positions[:, 0], rng.uniform(-0.5, 0.5, 100) - start.positions[:, 1], np.zeros(100)], 1)
    there = walk(start, in_frame(start, way)).positions
    expected = np.stack([np.ones(100), start.positions[:, 1] + way[:, 1], np.zeros(100)], axis=1)
    np.testing.assert_allclose(there, expected, atol=1e-12)


def test_walking_there_and_back_returns() -> None:
    sphere = shapes.jittered(shapes.icosphere(3), 0.1)
    points = random_points(sphere, 300)
    step = np.random.default_rng(4).normal(size=(300, 2)) * 0.3
    there = walk(points, step)
    assert (there.face != points.face).mean() > 0.9
    # the way back starts against the direction of arrival, found by walking almost all the way
    almost = walk(points, step * (1 - 1e-7))
    same = almost.face == there.face
    back = in_frame(there, almost.positions - there.positions)
    back *= (np.linalg.norm(step, axis=1) / np.linalg.norm(back, axis=1))[:, None]
    home = walk(there, back)
    error = np.linalg.norm(home.positions - points.positions, axis=1)[same]
    assert np.quantile(error, 0.95) < 1e-6  # a rare line passes a vertex on the other side


def test_a_walk_reads_only_the_mesh_it_is_on() -> None:
    """Rotated corners of the faces are other frames but the same walk."""
    sphere = shapes.bumpy_sphere(2)
    turned = Mesh(sphere.vertices, np.roll(sphere.faces, 1, axis=1))
    points = random_points(sphere, 100)
    same = SurfacePoints(turned, points.face, np.roll(points.barycentric, 1, axis=1))
    way = np.random.default_rng(5).normal(size=(100, 3))
    ends = [walk(p, in_frame(p, way)).positions for p in (points, same)]
    np.testing.assert_allclose(*ends, atol=1e-9)


def test_max_crossings_bounds_the_walk() -> None:
    square = flat()
    points = random_points(square, 50)
    end = walk(points, np.full((50, 2), 1e9), max_crossings=3)
    assert np.isfinite(end.barycentric).all()
    torus = shapes.torus(12, 8)
    around = walk(random_points(torus, 50), np.full((50, 2), 1e6), max_crossings=200)  # must come to an end
    assert (around.barycentric >= 0).all()


def test_displacements_that_are_not_numbers_move_nothing() -> None:
    points = random_points(shapes.icosphere(1), 4)
    step = np.array([[np.nan, 1], [np.inf, 0], [0, 0], [0, 0]])
    there = walk(points, step)
    np.testing.assert_array_equal(there.face, points.face)
    np.testing.assert_allclose(there.barycentric, points.barycentric, atol=1e-15)
    with pytest.raises(MeshError, match=r"\(4, 2\)"):
        walk(points, np.zeros((4, 3)))


def test_walls_keep_points_in_their_faces() -> None:
    points = random_points(shapes.icosphere(2), 100)
    there = walk(points, np.random.default_rng(6).normal(size=(100, 2)), walled=True)
    np.testing.assert_array_equal(there.face, points.face)
    assert (there.barycentric.min(axis=1) < 1e-12).all()


def test_non_manifold_edges_are_walls_and_bad_faces_are_not_entered() -> None:
    v = [[0, 0, 0], [1, 0, 0], [0.5, 1, 0], [0.5, -1, 0], [0.5, 0, 1], [2, 1, 0]]
    three = Mesh(v, [[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 5, 2], [1, 1, 2]])
    table = neighbours(three)
    assert (table[:3, 2] < 0).all()  # the edge of three faces
    assert table[0, 0] // 9 == 3 and table[3, 1] // 9 == 0  # edge 1-2: the face with a repeated vertex does not count
    start = SurfacePoints(three, [0], [[0.4, 0.3, 0.3]])
    end = walk(start, [[0.1, -5.0]])
    assert end.face[0] == 0 and end.barycentric[0, 2] == 0


def test_repeated_faces_lead_where_the_first_copy_leads() -> None:
    sphere = shapes.icosphere(1)
    copied = Mesh(sphere.vertices, np.concatenate([sphere.faces, np.roll(sphere.faces[:20], 1, axis=1)]))
    points = random_points(sphere, 20)
    original = SurfacePoints(sphere, np.arange(20), points.barycentric)
    copies = SurfacePoints(copied, 80 + np.arange(20), np.roll(points.barycentric, 1, axis=1))
    way = np.random.default_rng(7).normal(size=(20, 3)) * 0.5
    ends = [walk(p, in_frame(p, way)).positions for p in (original, copies)]
    np.testing.assert_allclose(*ends, atol=1e-12)


def test_degenerate_faces_are_crossed() -> None:
    """A square cut by a sliver without area: the walk comes out on the other side."""
    v = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 0]]
    mesh = Mesh(v, [[0, 1, 2], [0, 2, 4], [0, 4, 3], [4, 2, 3]])
    start = SurfacePoints(mesh, [0], [[0.2, 0.6, 0.2]])
    end = walk(start, in_frame(start, np.array([[-0.5, 0.5, 0]]) - 0.07 * np.array([[1, 0, 0]])))
    assert np.isfinite(end.barycentric).all()
    np.testing.assert_allclose(end.positions, start.positions + np.array([-0.57, 0.5, 0]), atol=1e-4)


def test_turned_over_points_stay_and_go_round_a_vertex() -> None:
    sphere = shapes.icosphere(2)
    inner = random_points(sphere, 5)
    assert not turned_over(inner)[1].any()
    on_edge = SurfacePoints(sphere, inner.face, [[0.0, 0.3, 0.7]] * 5)
    other, turned = turned_over(on_edge)
    assert turned.all() and (other.face != on_edge.face).all()
    np.testing.assert_allclose(other.positions, on_edge.positions, atol=1e-15)
    back, _ = turned_over(other)
    np.testing.assert_array_equal(back.face, on_edge.face)
    at, visited = SurfacePoints.at_vertices(sphere, [7]), set()
    for _ in range(6):
        visited.add(int(at.face[0]))
        at = turned_over(at)[0]
    assert visited == set(np.flatnonzero((sphere.faces == 7).any(axis=1)))


def test_gradient_is_the_derivative_along_a_walk() -> None:
    sphere = shapes.bumpy_sphere(2)
    points = random_points(sphere, 60)
    values = np.random.default_rng(8).normal(size=(sphere.n_vertices, 3))
    slope = gradient(points, values)
    for axis in range(2):
        step = np.zeros((60, 2))
        step[:, axis] = 1e-7
        near = points.barycentric.min(axis=1) > 1e-3
        change = (walk(points, step).interpolate(values) - points.interpolate(values)) / 1e-7
        np.testing.assert_allclose(change[near], slope[near][:, :, axis], rtol=1e-5, atol=1e-4)


def test_kernel_agrees_with_a_walk_in_tiny_steps() -> None:
    """A naive twin: many small moves in space, each pulled back onto the plane of the face it is in."""
    sphere = shapes.bumpy_sphere(2)
    points = random_points(sphere, 12, seed=9)
    step = np.random.default_rng(9).normal(size=(12, 2)) * 0.25
    x, y = axes(points)
    for p in range(12):
        face, position = int(points.face[p]), points.positions[p]
        velocity = step[p, 0] * x[p] + step[p, 1] * y[p]
        for _ in range(2000):
            position = position + velocity / 2000
            weight = _weights(sphere, face, position)
            if weight.min() < 0:
                code = neighbours(sphere)[face, weight.argmin()]
                velocity = _unfolded(sphere, face, code // 9, velocity)
                face = code // 9
                weight = np.clip(_weights(sphere, face, position), 0, None)
                position = weight / weight.sum() @ sphere.vertices[sphere.faces[face]]
        end = walk(points[p], step[p : p + 1]).positions[0]
        assert np.linalg.norm(end - position) < 5e-3


def _weights(mesh: Mesh, face: int, position: NDArray) -> NDArray:
    corners = mesh.vertices[mesh.faces[face]]
    system = np.concatenate([corners.T, np.ones((1, 3))])
    return np.linalg.lstsq(system, np.append(position, 1), rcond=None)[0]


def _unfolded(mesh: Mesh, face: int, other: int, velocity: NDArray) -> NDArray:
    """The velocity turned about the common edge from the plane of one face into that of the other."""
    normal = [np.cross(*(np.diff(mesh.vertices[mesh.faces[f]], axis=0))) for f in (face, other)]
    normal = [n / np.linalg.norm(n) for n in normal]
    i, j = sorted(set(mesh.faces[face]) & set(mesh.faces[other]))
    edge = mesh.vertices[j] - mesh.vertices[i]
    edge /= np.linalg.norm(edge)
    return (velocity @ edge) * edge + (velocity @ np.cross(normal[0], edge)) * np.cross(normal[1], edge)


def test_layout_has_the_lengths_of_the_mesh() -> None:
    sphere = shapes.bumpy_sphere(2)
    c, x, y = layout(sphere).T
    a, b, apex = sphere.vertices[sphere.faces].transpose(1, 0, 2)
    np.testing.assert_allclose(c, np.linalg.norm(b - a, axis=1))
    np.testing.assert_allclose(np.hypot(x, y), np.linalg.norm(apex - a, axis=1))
    assert kernel.NO_NEIGHBOUR == -1 and (neighbours(sphere) >= 0).all()
