"""T-junctions are sewn, whatever the levels, digits and sides; gaps, touching edges and clean meshes are left alone."""

from __future__ import annotations

import time

import generated_shapes as shapes
import numpy as np
import pytest

from benchmarks.accuracy import spoiled
from geodesics import Mesh, SurfacePoints
from geodesics.check import check
from geodesics.repair import repair
from geodesics.repair.cleaning import cleaned
from geodesics.repair.sewing import sewn
from geodesics.topology.invariants import invariants
from geodesics.topology.junctions import junctions

RNG = np.random.default_rng(0)


def subdivided(mesh: Mesh, levels: int) -> Mesh:
    """The half in front with each face in 4 ** levels: 2 ** levels - 1 vertices lie on edges of the other half."""
    front = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0
    inner = Mesh(mesh.vertices, mesh.faces[front])
    for _ in range(levels):
        inner = spoiled.split_in_four(inner, np.ones(inner.n_faces, dtype=bool))
    return Mesh(inner.vertices, np.vstack([mesh.faces[~front], inner.faces]))


def two_strips(left: list[float], right: list[float], gap: float = 0.0, shift: float = 0.0) -> Mesh:
    """Two strips side by side along y, with vertices at these heights, that share none."""
    strips, faces = [], []
    for x, heights in ((-1.0, left), (1.0, right)):
        y = np.array(heights) + (shift if x > 0 else 0)
        inner, outer = np.full(len(y), gap if x > 0 else 0.0), np.full(len(y), x)
        start = sum(map(len, strips))
        strips.append(np.column_stack([np.append(inner, outer), np.append(y, y), np.zeros(2 * len(y))]))
        i = start + np.arange(len(y) - 1)
        lower, upper = np.stack([i, i + 1, i + len(y)], 1), np.stack([i + 1, i + 1 + len(y), i + len(y)], 1)
        faces.append(np.vstack([lower, upper]))
    return Mesh(np.vstack(strips), np.vstack(faces))


def soup(mesh: Mesh) -> Mesh:
    """As an STL file has it: triangles with corners of their own, in single precision."""
    corners = mesh.vertices[mesh.faces].reshape(-1, 3).astype(np.float32)
    return Mesh(corners.astype(np.float64), np.arange(3 * mesh.n_faces).reshape(-1, 3))


def written(mesh: Mesh, form: str) -> Mesh:
    """With coordinates as text in that format has them."""
    return Mesh([[float(form % x) for x in row] for row in mesh.vertices], mesh.faces)


@pytest.mark.parametrize("levels", [1, 2, 3])
@pytest.mark.parametrize("as_given", [lambda mesh: mesh, soup], ids=["vertices shared", "soup"])
def test_a_subdivided_half_is_sewn_to_the_other(levels: int, as_given: object) -> None:
    torn = subdivided(shapes.bumpy_sphere(2), levels)
    mesh = as_given(torn)  # type: ignore[operator]
    copy = cleaned(mesh)
    assert copy is not None and copy.corners is not None
    told = invariants(copy.mesh)
    assert (told.components, told.boundaries, told.genus) == (1, 0, 0)
    assert copy.mesh.n_vertices == torn.n_vertices and abs(copy.mesh.area / mesh.area - 1) < 1e-9
    assert any("T-junctions" in change for change in copy.changes) and cleaned(copy.mesh) is None


@pytest.mark.parametrize("form", ["%.6f", "%.6g", "%.7g"])
@pytest.mark.parametrize("place", [0.0, 0.5])
def test_six_digits_are_enough(form: str, place: float) -> None:
    ball = shapes.bumpy_sphere(2)
    moved = Mesh(ball.vertices + place * np.ptp(ball.vertices, axis=0), ball.faces)
    copy = cleaned(written(subdivided(moved, 2), form))
    assert copy is not None and invariants(copy.mesh).boundaries == 0


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_vertices_of_both_sides_between_those_of_the_other(scale: float) -> None:
    strips = two_strips([0, 2, 4, 6], [0, 1, 3, 5, 6])
    mesh = Mesh(scale * strips.vertices, strips.faces)
    at = junctions(mesh)
    assert sorted(at.vertex.tolist()) == [1, 2, 9, 10, 11]
    assert np.allclose(at.along, 0.5)
    faces, face, corners = sewn(mesh)
    assert len(faces) == mesh.n_faces + 5
    place = np.einsum("mij,mjk->mik", corners, mesh.vertices[mesh.faces[face]])
    assert np.allclose(place, mesh.vertices[faces], rtol=0, atol=1e-12 * scale)
    copy = cleaned(mesh)
    assert copy is not None
    assert (invariants(copy.mesh).components, invariants(copy.mesh).boundaries) == (1, 1)


@pytest.mark.parametrize(
    "mesh",
    [
        two_strips([0, 2, 4], [0, 1, 2, 3, 4], gap=3e-4),
        two_strips([0, 2, 4], [0, 2, 4], shift=1e-3),
        two_strips([0, 2, 4], [4, 5, 6]),
        two_strips([0, 2, 4], [0, 2, 4], gap=1e-3),
        shapes.rectangle(6, 6),
        shapes.cylinder(),
        shapes.icosphere(2),
    ],
    ids=["gap", "shifted along a gap", "end to end", "lips", "open", "tube", "closed"],
)
def test_what_is_not_to_be_sewn(mesh: Mesh) -> None:
    assert len(junctions(mesh)) == 0 and "W229" not in {note.code for note in check(mesh)}
    faces, face, _ = sewn(mesh)
    assert np.array_equal(faces, mesh.faces) and np.array_equal(face, np.arange(mesh.n_faces))


def test_edges_that_cross_or_touch_in_a_point_are_not_sewn() -> None:
    flat = np.array([[-1.0, 0, 0], [1, 0, 0], [0, -1, 0]])
    touching = np.array([[0.3, 0, 0], [0.1, 1, 0], [0.5, 1, 0]])
    standing = np.array([[0, 0, -1], [0, 0, 1.0], [0, 1, 0]])
    for other in (touching, standing):
        assert len(junctions(Mesh(np.vstack([flat, other]), [[0, 1, 2], [3, 4, 5]]))) == 0


def test_points_go_to_the_clean_copy_and_back() -> None:
    mesh = subdivided(shapes.bumpy_sphere(1), 2)
    copy = cleaned(mesh)
    assert copy is not None
    weights = RNG.dirichlet((1, 1, 1), mesh.n_faces)
    given = SurfacePoints(mesh, np.arange(mesh.n_faces), weights)
    there = SurfacePoints(copy.mesh, *copy.of_given(given))
    assert np.allclose(there.positions, given.positions, rtol=0, atol=1e-9)
    back = copy.on_given(there)
    assert np.array_equal(back.face, given.face) and np.allclose(back.barycentric, weights, rtol=0, atol=1e-9)


def test_repair_sews_when_asked_and_check_says_so() -> None:
    mesh = subdivided(shapes.bumpy_sphere(2), 1)
    found = {note.code: note for note in check(mesh)}["W229"]
    assert found.severity == "warning" and found.count == len(np.unique(junctions(mesh).vertex))
    assert found.count == {note.code: note for note in check(soup(mesh))}["W229"].count
    better = repair(mesh, sew=True)
    assert invariants(better.mesh).boundaries == 0 and {note.code: note.count for note in better.notes} == {
        "W229": found.count
    }
    assert np.array_equal(better.mesh.vertices[better.new_vertex], mesh.vertices)
    assert np.array_equal(better.face[better.new_face], np.arange(mesh.n_faces))
    assert invariants(repair(mesh).mesh).boundaries > 0
    assert invariants(repair(soup(mesh), weld=True, sew=True).mesh).boundaries == 0


def test_one_very_long_edge_among_many_short_ones_costs_little() -> None:
    many = np.linspace(0, 1000, 20001).tolist()
    mesh = two_strips([0, 1000], many)
    started = time.process_time()
    at = junctions(mesh)
    assert len(at) == 19999 and time.process_time() - started < 5
    faces, _, _ = sewn(mesh)
    assert len(faces) == mesh.n_faces + 19999
