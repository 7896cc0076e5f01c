"""Notes on meshes: every defect is found where it was put, and a clean mesh has none."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import (
    bumpy_sphere,
    cylinder,
    icosphere,
    joined,
    moved,
    rectangle,
    tetrahedron,
    torus,
    with_isolated,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from odd_shapes import bow_tie as touching_balls

from geodesics import Mesh, Note, orient_faces, read_mesh
from geodesics.check import check
from geodesics.topology.orientation import orientation

DATA = os.environ.get("GMDS_DATA", "")


def with_faces(mesh: Mesh, *faces: list[int]) -> Mesh:
    return Mesh(mesh.vertices, np.vstack([mesh.faces, faces]))


def notes(mesh: Mesh) -> dict[str, Note]:
    return {note.code: note for note in check(mesh)}


def moebius(n: int = 20) -> Mesh:
    """A strip of 2 n triangles, glued with half a turn."""
    t = 2 * np.pi * np.arange(n) / n
    rim = [np.stack([(1 + s * np.cos(t / 2)) * np.cos(t), (1 + s * np.cos(t / 2)) * np.sin(t), s * np.sin(t / 2)], 1)
           for s in (-0.3, 0.3)]  # fmt: skip
    a = np.arange(n)
    b = a + 1
    low, high = np.where(b == n, n, b), np.where(b == n, 0, b + n)
    return Mesh(np.vstack(rim), np.vstack([np.stack([a, low, a + n], 1), np.stack([low, high, a + n], 1)]))


@pytest.mark.parametrize("mesh", [icosphere(2), bumpy_sphere(2), torus(), tetrahedron(), rectangle(4, 4), cylinder()])
def test_clean_meshes_have_no_warnings(mesh: Mesh) -> None:
    assert not [str(note) for note in check(mesh) if note.severity == "warning"]


@pytest.mark.parametrize(
    ("mesh", "euler", "genus", "loops"),
    [
        (icosphere(1), 2, 0, 0),
        (torus(), 0, 1, 0),
        (rectangle(4, 4), 1, 0, 1),
        (cylinder(), 0, 0, 2),
        (joined(icosphere(1), torus()), 2, 1, 0),
        (joined(torus(), torus(), rectangle(3, 3)), 1, 2, 1),
    ],
)
def test_topology(mesh: Mesh, euler: int, genus: int, loops: int) -> None:
    found = notes(mesh)
    assert found["W218"].message == f"Euler characteristic {euler}, genus {genus}"
    assert found["W217"].message.startswith(f"{loops} ") if loops else "W217" not in found


def test_each_defect_is_found_where_it_is() -> None:
    mesh = icosphere(1)
    m, n = mesh.n_faces, mesh.n_vertices
    a, b, c = mesh.faces[7].tolist()
    assert notes(with_faces(mesh, [b, a, c]))["W201"].indices == (m,)
    assert notes(with_faces(mesh, [4, 4, 9]))["W202"].indices == (m,)
    assert "W213" not in notes(with_faces(mesh, [4, 4, 9]))
    assert set(notes(with_isolated(mesh))["W215"].indices) == {0, n // 2 + 1, n + 2}
    flat = Mesh(np.vstack([mesh.vertices, mesh.vertices[[a, b]].mean(axis=0)]), np.vstack([mesh.faces, [a, b, n]]))
    assert notes(flat)["W203"].indices == (m,)
    spike = Mesh(np.vstack([mesh.vertices, [1000, 0, 0]]), np.vstack([mesh.faces, [a, b, n]]))
    assert notes(spike)["W209"].indices == (n,)
    branch = notes(Mesh(np.vstack([mesh.vertices, [2, 0, 0]]), np.vstack([mesh.faces, [a, b, n]])))
    assert set(branch["W213"].indices) == {a, b}
    assert "genus" not in branch["W218"].message


def test_components_and_coincident_vertices() -> None:
    twice = Mesh(np.vstack([icosphere(1).vertices] * 2), np.vstack([icosphere(1).faces, icosphere(1).faces + 42]))
    found = notes(twice)
    assert found["W216"].message == "2 components, of 42, 42 vertices"
    assert found["W219"].indices == tuple(range(42, 84))
    many = joined(*[icosphere(0)] * 5, with_isolated(icosphere(1)), tetrahedron())
    assert notes(many)["W216"].message == "7 components, of 42, 12, 12, 12, 12 vertices"


def test_warnings_come_first_and_a_note_counts_all_and_lists_a_hundred() -> None:
    mesh = icosphere(2)
    found = check(with_faces(rectangle(4, 4), *rectangle(4, 4).faces.tolist()))
    assert [note.severity for note in found] == sorted((note.severity for note in found), reverse=True)
    assert {note.severity for note in found} == {"warning", "info"}
    twice = notes(with_faces(mesh, *mesh.faces.tolist()))["W201"]
    assert twice.message.startswith("320 ") and twice.count == 320
    assert twice.indices == tuple(range(320, 420))


def test_bow_tie_vertex() -> None:
    v = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0.5], [0, -1, 0.5]])
    found = notes(Mesh(v, [[0, 1, 2], [0, 3, 4]]))
    assert found["W214"].indices == (0,)
    assert found["W217"].message == "2 boundary loops with 6 edges"
    assert "W213" not in found
    assert notes(cylinder(32, 16))["W217"].message == "2 boundary loops with 64 edges"
    assert notes(touching_balls().mesh)["W218"].message == "Euler characteristic 3, genus 0"


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
def test_notes_do_not_depend_on_scale_or_place(scale: float) -> None:
    a, b, _ = icosphere(1).faces[7].tolist()
    mesh = with_faces(with_isolated(icosphere(1)), [a, b, b], [5, 6, 40])
    assert {(x.code, x.indices) for x in check(moved(mesh, scale))} == {(x.code, x.indices) for x in check(mesh)}


def test_far_from_the_origin_is_reported() -> None:
    mesh = icosphere(2)
    assert "W208" not in notes(Mesh(mesh.vertices + 1e8, mesh.faces))
    assert "W208" in notes(Mesh(mesh.vertices + 1e10, mesh.faces))


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**31), st.floats(0.02, 0.98), st.booleans())
def test_any_flipped_faces_are_turned_back(seed: int, share: float, closed: bool) -> None:
    mesh = bumpy_sphere(1) if closed else rectangle(6, 6)
    flip = np.random.default_rng(seed).random(mesh.n_faces) < share
    mixed = Mesh(mesh.vertices, np.where(flip[:, None], mesh.faces[:, [0, 2, 1]], mesh.faces))
    found = orientation(mixed)
    assert found.turn.sum() == min(flip.sum(), (~flip).sum())
    assert np.array_equal(found.turn, flip) or np.array_equal(found.turn, ~flip)
    fixed = orient_faces(mixed)
    assert np.array_equal(fixed.vertices, mesh.vertices)
    assert np.array_equal(np.sort(fixed.faces, axis=1), np.sort(mesh.faces, axis=1))
    if closed:
        assert np.array_equal(fixed.faces, mesh.faces)  # the sphere came oriented outwards
    else:
        assert not orientation(fixed).turn.any()


def test_an_oriented_mesh_is_returned_as_it_is() -> None:
    for mesh in (icosphere(1), rectangle(3, 3), joined(icosphere(1), torus())):
        assert orient_faces(mesh) is mesh


def test_inside_out_closed_parts_are_turned_each_on_its_own() -> None:
    sphere, ring = icosphere(1), torus()
    both = joined(Mesh(sphere.vertices, sphere.faces[:, ::-1]), ring)
    assert set(notes(both)["W204"].indices) == set(range(sphere.n_faces))
    fixed = orient_faces(both)
    corners = fixed.vertices[fixed.faces[: sphere.n_faces]]
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("fi,fi->f", outward, corners.mean(axis=1)) > 0).all()
    assert np.array_equal(fixed.faces[sphere.n_faces :], both.faces[sphere.n_faces :])


def test_what_has_no_inside_is_not_inside_out() -> None:
    """Open parts, whichever way they bulge; and closed ones that are folded flat."""
    ball, sheet = icosphere(2), rectangle(4, 4)
    bowl = Mesh(ball.vertices, ball.faces[ball.vertices[ball.faces].mean(axis=1)[:, 2] < 0.3][:, ::-1])
    rim = (sheet.vertices[:, :2] % 1 == 0).any(axis=1)
    back = np.where(rim, np.arange(25), 25 + np.arange(25))
    folded = Mesh(np.vstack([sheet.vertices] * 2), np.vstack([sheet.faces, back[sheet.faces][:, ::-1]]))
    for seed in range(4):
        for mesh in (moved(bowl, 1.0, seed), moved(folded, 1.0, seed)):
            assert orient_faces(mesh) is mesh and "W204" not in notes(mesh)


def test_a_moebius_strip_has_no_orientation_and_stays_as_it_is() -> None:
    strip = moebius()
    found = notes(strip)
    assert len(found["W212"].indices) == 40 and "W204" not in found
    assert "genus" not in found["W218"].message and found["W217"].message.startswith("1 boundary loop")
    assert orient_faces(strip) is strip


@pytest.mark.skipif(not DATA, reason="GMDS_DATA is not set")
def test_known_defects_of_published_files() -> None:
    found = notes(read_mesh(Path(DATA) / "tosca_hires" / "centaur3.off"))
    assert found["W204"].message.startswith("376 ")
    assert "W204" not in notes(read_mesh(Path(DATA) / "tosca_hires" / "centaur0.off"))
    assert found["W218"].message == "Euler characteristic 2, genus 0"
    gorilla = notes(read_mesh(Path(DATA) / "tosca_nonrigid_3k" / "gorilla1"))
    assert gorilla["W216"].message.startswith("21 components") and len(gorilla["W201"].indices) == 13
    assert "W213" in notes(read_mesh(Path(DATA) / "tosca_nonrigid_3k" / "david1"))
    bear = notes(read_mesh(Path(DATA) / "shrec20" / "models" / "bear.obj"))
    assert bear["W217"].message.startswith("1 boundary loop")
