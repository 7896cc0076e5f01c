"""Laws of maps, on random maps between odd surfaces: identity, composition, inverse, transfer, files."""

from __future__ import annotations

import functools
import io
import itertools
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, disc, icosphere, joined, moved, tetrahedron, torus, with_isolated
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from geodesics import Mesh, SurfacePoints
from gmds.correspondence import Correspondence
from gmds.errors import MapError
from gmds.maps.images import image, preimage
from gmds.maps.point_map import MatchStatus

Array = NDArray[np.float64]

MESHES = {
    "triangle": lambda: Mesh(np.eye(3), np.array([[0, 1, 2]])),
    "tetrahedron": tetrahedron,
    "bumps": lambda: bumpy_sphere(1),
    "torus": lambda: torus(8, 6),
    "disc": lambda: disc(3),
    "isolated": lambda: with_isolated(icosphere(0)),
    "two parts": lambda: joined(icosphere(0), bumpy_sphere(1)),
}
LAWS = settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture])
FEW = settings(LAWS, max_examples=20)


@functools.cache
def mesh_of(name: str) -> Mesh:
    return MESHES[name]()


def rows(mesh: Mesh, count: int, rng: np.random.Generator) -> SurfacePoints:
    """Random points: inside faces, on edges, at corners, next to corners."""
    weights = rng.dirichlet(np.ones(3), count)
    kind = rng.integers(4, size=count)
    weights[kind == 1, 0] = 0
    weights[kind == 2] = np.eye(3)[rng.integers(3, size=count)][kind == 2]
    weights[kind == 3] = [1 - 3e-9, 2e-9, 1e-9]
    return SurfacePoints(mesh, rng.integers(mesh.n_faces, size=count), weights / weights.sum(axis=1, keepdims=True))


def some_map(source: Mesh, target: Mesh, rng: np.random.Generator) -> Correspondence:
    """Any map whatever, a fifth of it not valid."""
    n = source.n_vertices
    status = list(MatchStatus)[rng.integers(4)]
    return Correspondence(source, target, rows(target, n, rng), rng.random(n) > 0.2, rng.random(n), status)


def vertex_map(source: Mesh, target: Mesh, indices: Array) -> Correspondence:
    return Correspondence.from_points(source, SurfacePoints.at_vertices(target, indices))


def identity(mesh: Mesh) -> Correspondence:
    """Each vertex where it is; those on no face at vertex 0 of the first face, and not valid."""
    on_faces = np.isin(np.arange(mesh.n_vertices), mesh.faces)
    return vertex_map(mesh, mesh, np.where(on_faces, np.arange(mesh.n_vertices), mesh.faces[0, 0]))


def same(one: Correspondence, other: Correspondence, near: float = 0.0) -> bool:
    """Whether points are equal, to within a share of the target's extent, and validity and distortion are."""
    gap = np.linalg.norm(one.points.positions - other.points.positions, axis=1).max()
    alike = np.array_equal(one.valid, other.valid) and np.allclose(one.distortion, other.distortion, 1e-12, 1e-15)
    return bool(alike and gap <= near * np.ptp(one.target.vertices))


names = st.sampled_from(sorted(MESHES))
seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)


@LAWS
@given(names, names, seeds)
def test_the_identity_changes_nothing(source: str, target: str, rng: np.random.Generator) -> None:
    answer = some_map(mesh_of(source), mesh_of(target), rng)
    before = identity(answer.source).compose(answer)
    on_faces = np.isin(np.arange(answer.source.n_vertices), answer.source.faces)
    assert np.array_equal(before.points.face[on_faces], answer.points.face[on_faces])
    assert np.array_equal(before.points.barycentric[on_faces], answer.points.barycentric[on_faces])
    assert np.array_equal(before.valid, answer.valid & on_faces)
    assert same(answer.compose(identity(answer.target)), answer, near=1e-12)


@LAWS
@given(names, names, names, names, seeds)
def test_vertex_maps_compose_as_functions_do(a: str, b: str, c: str, d: str, rng: np.random.Generator) -> None:
    meshes = [mesh_of(name) for name in (a, b, c, d)]
    steps = [rng.choice(np.unique(to.faces), from_.n_vertices) for from_, to in itertools.pairwise(meshes)]
    p, q, r = (vertex_map(*meshes[i : i + 2], steps[i]) for i in range(3))
    one, two = p.compose(q).compose(r), p.compose(q.compose(r))
    assert np.array_equal(one.points.face, two.points.face)
    assert np.array_equal(one.points.barycentric, two.points.barycentric)
    assert np.array_equal(one.valid, two.valid)
    assert np.array_equal(one.vertex_map(), steps[2][steps[1][steps[0]]])
    values = rng.standard_normal(meshes[3].n_vertices)
    assert np.array_equal(one.transfer(values), p.transfer(q.transfer(r.transfer(values))))


@LAWS
@given(names, names, seeds)
def test_what_keeps_faces_composes_exactly(source: str, target: str, rng: np.random.Generator) -> None:
    """Onto a deformed copy of the target and on to another: points stay in their faces, with their weights."""
    first = some_map(mesh_of(source), mesh_of(target), rng)
    copies = [first.target]
    for scale in (3e-5, 7e4):
        old = copies[-1]
        stretched = old.vertices * rng.uniform(0.8, 1.25, 3) * scale
        copies.append(Mesh(stretched + 0.01 * scale * rng.standard_normal(3), old.faces))
    steps = [vertex_map(here, there, identity(here).vertex_map()) for here, there in itertools.pairwise(copies)]
    one = first.compose(steps[0]).compose(steps[1])
    expected = SurfacePoints(copies[2], first.points.face, first.points.barycentric).positions
    assert np.abs(one.points.positions - expected).max() <= 1e-9 * np.ptp(copies[2].vertices)
    assert np.array_equal(one.valid, first.valid)
    assert same(one, first.compose(steps[0].compose(steps[1])), near=1e-9)


@LAWS
@given(names, st.booleans(), st.floats(-6, 6), seeds)
def test_a_map_that_is_one_to_one_is_inverted(
    name: str, mirrored: bool, power: float, rng: np.random.Generator
) -> None:
    source = mesh_of(name)
    on_faces = np.isin(np.arange(source.n_vertices), source.faces)
    order = rng.permutation(source.n_vertices)
    rank = np.argsort(order)
    sign = np.array([-1.0 if mirrored else 1.0, 1, 1])
    copy = moved(Mesh(source.vertices[order] * sign, rank[source.faces]), 10**power, seed=int(rng.integers(99)))
    there = vertex_map(source, copy, np.where(on_faces, rank, rank[source.faces[0, 0]]))
    back = there.inverse()
    assert np.array_equal(back.valid, on_faces[order])
    assert np.array_equal(back.vertex_map()[back.valid], order[back.valid])
    assert np.array_equal(back.inverse().vertex_map()[on_faces], rank[on_faces])
    round_trip = there.compose(back)
    assert np.array_equal(round_trip.valid, on_faces)
    assert np.array_equal(round_trip.vertex_map()[on_faces], np.flatnonzero(on_faces))
    assert np.abs(round_trip.points.positions - source.vertices)[on_faces].max() <= 1e-9 * np.ptp(source.vertices)

    valid = on_faces & (rng.random(source.n_vertices) > 0.15)
    covered = np.isin(order, source.faces[valid[source.faces].all(axis=1)])  # by the image of a face that is all valid
    partly = Correspondence.from_points(source, there.points, valid=valid).inverse()
    assert partly.valid[covered].all()
    assert np.array_equal(partly.vertex_map()[covered], order[covered])


@LAWS
@given(names, names, names, seeds)
def test_validity_distortion_and_status_of_a_composition(a: str, b: str, c: str, rng: np.random.Generator) -> None:
    first, second = some_map(mesh_of(a), mesh_of(b), rng), some_map(mesh_of(b), mesh_of(c), rng)
    both = first.compose(second)
    for i, (face, weights) in enumerate(zip(first.points.face, first.points.barycentric, strict=True)):
        corners = second.source.faces[face]
        there = all(second.valid[corner] for corner, weight in zip(corners, weights, strict=True) if weight > 0)
        assert both.valid[i] == (first.valid[i] and there)
        assert both.distortion[i] == pytest.approx(first.distortion[i] + weights @ second.distortion[corners])
    assert both.status.rank == max(first.status.rank, second.status.rank)
    assert both.source is first.source and both.target is second.target


@LAWS
@given(names, names, seeds)
def test_rows_do_not_know_of_each_other(source: str, target: str, rng: np.random.Generator) -> None:
    """One row, no row, rows in another order: each the same as among all the others."""
    answer = some_map(mesh_of(source), mesh_of(target), rng)
    points = rows(answer.source, 9, rng)
    whole, valid, distortion = image(answer, points)
    for chosen in ([4], [], rng.permutation(9)):
        part, part_valid, part_distortion = image(answer, points[np.array(chosen, dtype=int)])
        assert len(part) == len(chosen)
        assert np.allclose(part.positions, whole.positions[chosen], atol=1e-12 * np.ptp(answer.target.vertices))
        assert np.array_equal(part_valid, valid[chosen]) and np.array_equal(part_distortion, distortion[chosen])
    back = answer.inverse()
    for vertices in ([answer.target.n_vertices - 1], []):
        alone, gap = preimage(answer, vertices)
        assert len(alone) == len(gap) == len(vertices)
        assert np.allclose(alone.positions, back.points.positions[vertices], atol=1e-9)


@LAWS
@given(names, names, seeds)
def test_maps_of_nothing(source: str, target: str, rng: np.random.Generator) -> None:
    answer = some_map(mesh_of(source), mesh_of(target), rng)
    nothing = Correspondence.from_points(
        answer.source, answer.points, valid=np.zeros(answer.source.n_vertices, dtype=bool)
    )
    back = nothing.inverse()
    assert not back.valid.any() and np.isfinite(back.points.positions).all() and np.isfinite(back.distortion).all()
    onward = some_map(answer.target, answer.source, rng)
    assert not nothing.compose(onward).valid.any()
    assert not onward.compose(nothing).valid.any()
    assert (nothing.transfer(rng.random(answer.target.n_vertices), fill=-7) == -7).all()


@LAWS
@given(names, names, seeds, st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
def test_transfer_is_linear(source: str, target: str, rng: np.random.Generator, a: float, b: float) -> None:
    answer = some_map(mesh_of(source), mesh_of(target), rng)
    n = answer.target.n_vertices
    x, y = rng.standard_normal((2, n, 3))
    moved_x, moved_y = answer.transfer(x), answer.transfer(y)
    np.testing.assert_allclose(
        answer.transfer(a * x + b * y), a * moved_x + b * moved_y, atol=1e-11 * (abs(a) + abs(b) + 1)
    )
    assert np.array_equal(answer.transfer(x[:, 1]), moved_x[:, 1])
    np.testing.assert_allclose(answer.transfer(np.full(n, a)), a, rtol=1e-14, atol=1e-300)
    corners = x[answer.target.faces[answer.points.face]]
    assert (moved_x >= corners.min(axis=1) - 1e-12).all() and (moved_x <= corners.max(axis=1) + 1e-12).all()
    np.testing.assert_allclose(answer.transfer(answer.target.vertices), answer.points.positions, atol=1e-13)
    np.testing.assert_allclose(answer.transfer(x + 1j * y), moved_x + 1j * moved_y, atol=1e-12)


@LAWS
@given(names, names, seeds)
def test_labels_are_chosen_and_never_made(source: str, target: str, rng: np.random.Generator) -> None:
    answer = some_map(mesh_of(source), mesh_of(target), rng)
    labels = rng.integers(3, size=answer.target.n_vertices)
    found = answer.transfer(labels)
    for i, (face, weights) in enumerate(zip(answer.points.face, answer.points.barycentric, strict=True)):
        share = np.bincount(labels[answer.target.faces[face]], weights, minlength=3)
        assert share[found[i]] >= share.max() - 1e-9 and share[found[i]] > 0
    renamed = np.array(["ear", "paw", "tail"])
    assert np.array_equal(answer.transfer(renamed[labels]), renamed[found])


@LAWS
@given(st.sampled_from(["tetrahedron", "bumps", "torus", "disc", "two parts"]), seeds)
def test_a_point_on_a_border_is_one_point(name: str, rng: np.random.Generator) -> None:
    """On an edge that two faces share it does not matter in which of them a point is said to lie."""
    mesh = mesh_of(name)
    stretched = Mesh(mesh.vertices * rng.uniform(0.8, 1.25, 3), mesh.faces)
    answer = vertex_map(mesh, stretched, np.arange(mesh.n_vertices))
    a, b = np.sort(mesh.faces[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2).T
    t = rng.random(mesh.n_vertices**2).reshape(mesh.n_vertices, -1)[a, b]  # the same from both sides
    face, slot = np.arange(len(a)) // 3, np.arange(len(a)) % 3
    forward = mesh.faces[face, slot] == a
    weights = np.zeros((len(a), 3))
    weights[np.arange(len(a)), slot] = np.where(forward, t, 1 - t)
    weights[np.arange(len(a)), (slot + 1) % 3] = np.where(forward, 1 - t, t)
    values = rng.standard_normal(mesh.n_vertices)
    points = SurfacePoints(mesh, face, weights)
    sent = image(answer, points)[0].positions
    order = np.lexsort((b, a))
    twins = order[:-1][(a[order][:-1] == a[order][1:]) & (b[order][:-1] == b[order][1:])]
    others = order[1:][(a[order][:-1] == a[order][1:]) & (b[order][:-1] == b[order][1:])]
    assert len(twins)
    for read in (sent, points.positions, points.interpolate(values)):
        np.testing.assert_allclose(read[twins], read[others], atol=1e-12 * np.ptp(mesh.vertices))


@FEW
@given(names, names, seeds)
def test_files_and_pickles_hold_the_very_same_map(
    tmp_path_factory: pytest.TempPathFactory, source: str, target: str, rng: np.random.Generator
) -> None:
    answer = some_map(mesh_of(source), mesh_of(target), rng)
    path: Path = tmp_path_factory.mktemp("maps") / "map.npz"
    answer.save(path)
    loaded = Correspondence.load(path, answer.source, answer.target)
    unpickled: Any = pickle.load(io.BytesIO(pickle.dumps(answer)))
    for other, distortion in ((loaded, answer.distortion.astype(np.float32)), (unpickled, answer.distortion)):
        assert np.array_equal(other.points.face, answer.points.face)
        assert np.array_equal(other.points.barycentric, answer.points.barycentric)
        assert np.array_equal(other.valid, answer.valid) and np.array_equal(other.distortion, distortion)
        assert other.status is answer.status
    first = path.read_bytes()
    loaded.save(path)
    assert path.read_bytes() == first


def test_maps_meet_on_the_very_same_mesh_only() -> None:
    rng = np.random.default_rng(0)
    first, second = some_map(tetrahedron(), icosphere(0), rng), some_map(icosphere(0), tetrahedron(), rng)
    with pytest.raises(MapError, match=r"E310.*same object"):
        first.compose(second)
    with pytest.raises(MapError, match=r"E310.*same object"):
        image(second, first.points)
