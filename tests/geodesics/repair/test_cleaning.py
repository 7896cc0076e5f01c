"""Clean copies: what is welded, taken apart and left out, and that what is clean stays as it is."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest

from benchmarks.accuracy import spoiled
from geodesics import Mesh
from geodesics.repair.cleaning import cleaned
from geodesics.repair.welding import seam_welds
from geodesics.topology.edges import edges
from geodesics.topology.invariants import invariants


def sphere() -> Mesh:
    return shapes.icosphere(3)


def icosahedron() -> np.ndarray:
    """Directions (20, 3) of the middles of its faces."""
    coarse = shapes.icosphere(0)
    middle = coarse.vertices[coarse.faces].mean(axis=1)
    return np.asarray(middle / np.linalg.norm(middle, axis=1, keepdims=True))


@pytest.mark.parametrize(
    "mesh",
    [shapes.icosphere(2), shapes.rectangle(6, 6), shapes.joined(shapes.icosphere(1), shapes.icosphere(1))],
    ids=["closed", "open", "two parts on each other"],
)
def test_what_is_clean_has_no_copy(mesh: Mesh) -> None:
    assert cleaned(mesh) is None


@pytest.mark.parametrize("fault", spoiled.FAULTS, ids=lambda fault: fault.__name__)
def test_every_fault_leaves_one_closed_sphere(fault: object) -> None:
    mesh = fault(sphere(), np.random.default_rng(4))  # type: ignore[operator]
    copy = cleaned(mesh)
    if copy is None:
        assert fault in (spoiled.turned_faces, spoiled.floating)
        return
    assert copy.changes
    table = edges(copy.mesh)
    assert (table.n_faces == 2).all()
    floating = spoiled.PARTS if fault is spoiled.everything else 0
    told = invariants(copy.mesh)
    assert (told.components, told.boundaries) == (1 + floating, 0)
    n = sphere().n_vertices
    where = copy.vertex[:n][copy.vertex[:n] >= 0]
    assert len(where) >= n - 1  # the pinch takes one vertex away
    kept = np.flatnonzero(copy.vertex[:n] >= 0)
    assert np.array_equal(copy.mesh.vertices[where], mesh.vertices[kept])


@pytest.mark.parametrize("fault", spoiled.FAULTS, ids=lambda fault: fault.__name__)
def test_faces_lie_where_the_given_ones_do_corner_by_corner(fault: object) -> None:
    mesh = fault(sphere(), np.random.default_rng(1))  # type: ignore[operator]
    copy = cleaned(mesh)
    if copy is not None:
        here, there = copy.mesh.vertices[copy.mesh.faces], mesh.vertices[mesh.faces[copy.face]]
        split = np.zeros(copy.mesh.n_faces, dtype=bool)
        if copy.corners is not None:
            split = (copy.corners != np.eye(3)).any(axis=(1, 2))
            assert np.allclose(here, np.einsum("mij,mjk->mik", copy.corners, there), rtol=0, atol=1e-15)
        assert np.array_equal(here[~split], there[~split]) and split.any() == (fault is spoiled.t_junctions)


def test_patches_that_meet_in_corners_alone_are_no_small_pieces() -> None:
    mesh = sphere()
    patch = np.argmax(mesh.vertices[mesh.faces].mean(axis=1) @ icosahedron().T, axis=1)  # 20 of a twentieth each
    corner = np.array([len(np.unique(patch[(mesh.faces == v).any(axis=1)])) > 2 for v in range(mesh.n_vertices)])
    key = np.where(corner[mesh.faces], mesh.faces, mesh.faces + mesh.n_vertices * (1 + patch[:, None]))
    _, first, name = np.unique(key, return_index=True, return_inverse=True)
    torn = Mesh(1.0 * mesh.vertices[mesh.faces.ravel()[first]], name.reshape(-1, 3))
    shrunk = torn.vertices.copy()
    for one in range(20):  # towards their middle, so that they cannot be welded
        inside = np.setdiff1d(torn.faces[patch == one], torn.faces[patch != one])
        shrunk[inside] += 0.02 * (icosahedron()[one] - shrunk[inside])
    copy = cleaned(Mesh(shrunk, torn.faces))
    assert copy is not None and copy.mesh.n_faces == mesh.n_faces
    assert invariants(copy.mesh).components == 1


def test_corners_that_differ_by_rounding_are_welded_and_near_ones_are_not() -> None:
    mesh = spoiled.charts(sphere(), np.random.default_rng(0))
    rounded = Mesh(mesh.vertices + 1e-8 * np.random.default_rng(1).standard_normal(mesh.vertices.shape), mesh.faces)
    assert np.array_equal(seam_welds(mesh), seam_welds(rounded))
    apart = Mesh(mesh.vertices + 1e-2 * np.random.default_rng(1).standard_normal(mesh.vertices.shape), mesh.faces)
    assert np.array_equal(seam_welds(apart), np.arange(mesh.n_vertices))


def test_a_sheet_given_twice_is_one_sheet() -> None:
    sheet = shapes.rectangle(6, 6)
    n = sheet.n_vertices
    twice = Mesh(np.vstack([sheet.vertices] * 2), np.vstack([sheet.faces, sheet.faces[:, ::-1] + n]))
    copy = cleaned(twice)
    assert copy is not None and copy.mesh.n_faces == sheet.n_faces
    assert np.array_equal(copy.vertex[:n], copy.vertex[n:])


def test_two_bodies_that_touch_in_a_vertex_stay_joined() -> None:
    ball = sphere()
    other = np.where(ball.faces == 0, 0, ball.faces + ball.n_vertices)
    mesh = Mesh(np.vstack([ball.vertices, 2 * ball.vertices[0] - ball.vertices]), np.vstack([ball.faces, other]))
    copy = cleaned(mesh)
    assert copy is not None
    assert invariants(copy.mesh).components == 1
