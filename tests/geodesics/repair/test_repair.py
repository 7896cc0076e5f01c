"""Repair, decimation, remeshing, hole filling: better meshes with index arrays, or a clear refusal."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere, joined, rectangle, torus, with_isolated
from mesh_facts import area, warnings
from odd_shapes import bow_tie, fin

from geodesics import Mesh, MeshError
from geodesics.repair.decimation import decimate
from geodesics.repair.repairing import repair


def broken(mesh: Mesh) -> Mesh:
    """Isolated vertices, a repeated face, degenerate faces and a few turned faces."""
    mesh = with_isolated(mesh)
    f = mesh.faces.copy()
    f[[2, 9]] = f[[2, 9]][:, [0, 2, 1]]
    return Mesh(mesh.vertices, np.vstack([f[:5], [4, 4, 9], f[5:], f[3][[1, 2, 0]], [7, 8, 7]]))


def test_repair_removes_what_was_added_and_nothing_else() -> None:
    clean = icosphere(1)
    fixed, vertex, face, notes, *_ = repair(broken(clean))
    assert np.array_equal(fixed.vertices, clean.vertices) and np.array_equal(fixed.faces, clean.faces)
    assert {note.code for note in notes} == {"W201", "W202", "W204", "W215"}
    assert {note.code: len(note.indices) for note in notes} == {"W201": 1, "W202": 2, "W204": 2, "W215": 3}
    assert np.array_equal(broken(clean).vertices[vertex], fixed.vertices)
    assert np.array_equal(np.sort(broken(clean).faces[face]), np.sort(vertex[fixed.faces]))


def test_repair_of_a_clean_mesh_changes_nothing() -> None:
    for mesh in (icosphere(1), torus(), rectangle(3, 4)):
        fixed, vertex, face, notes, *_ = repair(mesh)
        assert np.array_equal(fixed.vertices, mesh.vertices) and np.array_equal(fixed.faces, mesh.faces)
        assert np.array_equal(vertex, np.arange(mesh.n_vertices)) and np.array_equal(face, np.arange(mesh.n_faces))
        assert notes == []


@pytest.mark.parametrize("largest", [False, True])
@pytest.mark.parametrize("cut", [False, True])
@pytest.mark.parametrize("number", range(4))
def test_the_way_there_and_back(number: int, cut: bool, largest: bool) -> None:
    """The maps both ways say the same, and name the same positions and faces."""
    old = (broken(icosphere(1)), joined(icosphere(1), torus()), fin().mesh, bow_tie().mesh)[number]
    result = repair(old, cut=cut, largest=largest)
    assert np.array_equal(result.mesh.vertices, old.vertices[result.vertex])
    assert np.array_equal(np.sort(result.vertex[result.mesh.faces]), np.sort(old.faces[result.face]))
    assert np.array_equal(result.new_face[result.face], np.arange(result.mesh.n_faces))
    there = result.new_vertex >= 0
    assert np.array_equal(result.mesh.vertices[result.new_vertex[there]], old.vertices[there])
    gone = np.setdiff1d(np.arange(old.n_vertices), result.vertex)
    assert (result.new_vertex[gone] == -1).all() and (result.new_face >= 0).sum() == result.mesh.n_faces


def test_a_welded_vertex_became_the_one_it_was_welded_to() -> None:
    mesh = icosphere(1)
    soup = Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(3 * mesh.n_faces).reshape(-1, 3))
    result = repair(soup, weld=True)
    assert np.array_equal(result.mesh.vertices[result.new_vertex], soup.vertices)
    assert np.array_equal(result.mesh.faces, result.new_vertex[soup.faces])


def test_what_was_asked_for_is_reported_and_counted() -> None:
    result = repair(joined(bow_tie().mesh, icosphere(0)), cut=True, largest=True)
    assert {note.code: note.count for note in result.notes} == {"W213": 1, "W216": 340}
    assert all(note.message.startswith(f"{note.count} ") for note in result.notes)


def test_welding_joins_equal_positions_when_asked() -> None:
    mesh = icosphere(1)
    soup = Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(3 * mesh.n_faces).reshape(-1, 3))
    assert repair(soup).mesh.n_vertices == soup.n_vertices
    fixed = repair(soup, weld=True)
    assert fixed.mesh.n_vertices == mesh.n_vertices
    assert np.array_equal(fixed.mesh.vertices[fixed.mesh.faces], mesh.vertices[mesh.faces])


def test_zero_and_minus_zero_are_one_place() -> None:
    twice = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-0.0, 0, -0.0], [0, 0, 1]], [[0, 1, 2], [3, 4, 1]])
    assert repair(twice, weld=True).mesh.n_vertices == 4 and "W219" in warnings(twice)


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
def test_decimation_keeps_the_surface_and_knows_where_points_come_from(scale: float) -> None:
    fine = Mesh(scale * bumpy_sphere(3).vertices, bumpy_sphere(3).faces)
    coarse = decimate(fine, 400)
    assert coarse.mesh.n_faces == 400
    assert abs(area(coarse.mesh) / area(fine) - 1) < 0.05
    moved = np.linalg.norm(coarse.mesh.vertices - fine.vertices[coarse.vertex], axis=1)
    assert np.median(moved) < 0.15 * scale and moved.max() < 0.6 * scale  # edges are about 0.25 long
    assert len(coarse.face) == 400 and coarse.face.max() < fine.n_faces
    assert not warnings(coarse.mesh)


def test_decimation_of_open_and_broken_meshes() -> None:
    assert decimate(rectangle(20, 20), 200).mesh.n_faces == 200
    coarse = decimate(broken(icosphere(2)), 100)
    assert np.linalg.norm(broken(icosphere(2)).vertices[coarse.vertex], axis=1).max() < 1.001


def test_decimation_refuses_what_it_cannot_do() -> None:
    mesh = icosphere(1)
    branch = Mesh(np.vstack([mesh.vertices, [3, 0, 0]]), np.vstack([mesh.faces, [*mesh.faces[0, :2], 42]]))
    with pytest.raises(MeshError, match="E110"):
        decimate(branch, 20)
    fold = Mesh(rectangle(6, 6).vertices, np.where(rectangle(6, 6).faces == 48, 0, rectangle(6, 6).faces))
    with pytest.raises(MeshError, match=r"E110.*1 vertices join several fans of faces, first \[0\]; cut"):
        decimate(fold, 30)
    assert decimate(repair(fold, cut=True).mesh, 30).mesh.n_faces <= 30
    for count in (3, 0, -1, 81):
        with pytest.raises(ValueError, match="from 4 to the 80"):
            decimate(mesh, count)
