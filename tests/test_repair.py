"""Repair, decimation, remeshing, hole filling: better meshes with a way back, or a clear refusal."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from odd_shapes import Odd, bow_tie, fin
from rare_shapes import strip
from shapes import bumpy_sphere, icosphere, joined, rectangle, torus, with_isolated

from geodesics import Mesh, MeshError, _meshlab
from geodesics.check import check
from geodesics.edges import face_components
from geodesics.errors import MissingExtra
from geodesics.repair import decimate, fill_holes, remesh, repair
from geodesics.splitting import split


def area(mesh: Mesh) -> float:
    a, b, c = mesh.vertices[mesh.faces.T]
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def warnings(mesh: Mesh) -> set[str]:
    return {note.code for note in check(mesh) if note.severity == "warning"}


def punctured(mesh: Mesh, vertex: int = 3) -> Mesh:
    """The mesh without the faces at one vertex."""
    return repair(Mesh(mesh.vertices, mesh.faces[(mesh.faces != vertex).all(axis=1)])).mesh


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


def test_what_was_asked_for_is_told_and_counted() -> None:
    result = repair(joined(bow_tie().mesh, icosphere(0)), cut=True, largest=True)
    assert {note.code: note.count for note in result.notes} == {"W213": 1, "W216": 340}
    assert all(note.message.startswith(f"{note.count} ") for note in result.notes)


@pytest.mark.parametrize("make", [fin, bow_tie])
def test_a_mesh_is_cut_where_it_is_no_surface_and_nowhere_else(make: Callable[[], Odd]) -> None:
    mesh = make().mesh
    apart, vertex = split(mesh)
    assert apart.n_vertices == mesh.n_vertices + (2 if make is fin else 1)
    assert np.array_equal(apart.vertices, mesh.vertices[vertex])
    assert np.array_equal(vertex[apart.faces], mesh.faces)
    assert np.array_equal(vertex[: mesh.n_vertices], np.arange(mesh.n_vertices))
    assert not warnings(apart) & {"W213", "W214"}
    sizes = np.bincount(face_components(apart))
    assert sorted(sizes) == ([1, 320] if make is fin else [320, 320])


def test_sound_meshes_are_not_cut() -> None:
    for mesh in (icosphere(1), torus(), rectangle(4, 4), strip(), joined(icosphere(0), icosphere(0))):
        assert split(mesh)[0] is mesh


@settings(max_examples=150, deadline=None)
@given(seed=st.integers(0, 2**31), n=st.integers(4, 9), m=st.integers(2, 30))
def test_any_soup_of_triangles_is_cut_into_surfaces(seed: int, n: int, m: int) -> None:
    rng = np.random.default_rng(seed)
    soup = repair(Mesh(rng.standard_normal((n, 3)), [rng.choice(n, 3, replace=False) for _ in range(m)]))
    apart, vertex = split(soup.mesh)
    assert not warnings(apart) & {"W213", "W214"}
    assert np.array_equal(vertex[apart.faces], soup.mesh.faces)
    again = repair(apart, cut=True)
    assert np.array_equal(again.vertex, np.arange(apart.n_vertices))


def test_welding_joins_equal_positions_when_asked() -> None:
    mesh = icosphere(1)
    soup = Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(3 * mesh.n_faces).reshape(-1, 3))
    assert repair(soup).mesh.n_vertices == soup.n_vertices
    fixed = repair(soup, weld=True)
    assert fixed.mesh.n_vertices == mesh.n_vertices
    assert np.array_equal(fixed.mesh.vertices[fixed.mesh.faces], mesh.vertices[mesh.faces])


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


def test_decimation_refuses_what_it_can_not_do() -> None:
    mesh = icosphere(1)
    branch = Mesh(np.vstack([mesh.vertices, [3, 0, 0]]), np.vstack([mesh.faces, [*mesh.faces[0, :2], 42]]))
    with pytest.raises(MeshError, match="E110"):
        decimate(branch, 20)
    for count in (3, 0, -1, 81):
        with pytest.raises(ValueError, match="from 4 to the 80"):
            decimate(mesh, count)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_remeshing_gives_as_many_good_triangles_as_asked(scale: float) -> None:
    pytest.importorskip("pymeshlab")
    old = Mesh(scale * bumpy_sphere(3).vertices, bumpy_sphere(3).faces)
    new = remesh(old, 900)
    assert abs(new.n_vertices / 900 - 1) < 0.1
    assert abs(area(new) / area(old) - 1) < 0.03
    sides = np.linalg.norm(new.vertices[new.faces] - new.vertices[np.roll(new.faces, -1, axis=1)], axis=2)
    assert np.median(sides.min(axis=1) / sides.max(axis=1)) > 0.75
    assert not warnings(new)
    again = remesh(old, 900)
    assert again.vertices.tobytes() == new.vertices.tobytes() and again.faces.tobytes() == new.faces.tobytes()


def test_filling_holes_closes_the_surface_and_keeps_what_is_there() -> None:
    pytest.importorskip("pymeshlab")
    holes = joined(punctured(icosphere(2)), punctured(punctured(torus()), 50))
    closed = fill_holes(holes)
    assert np.array_equal(closed.vertices, holes.vertices)
    assert np.array_equal(closed.faces[: holes.n_faces], holes.faces)
    assert "W217" in {note.code for note in check(holes)}
    assert "W217" not in {note.code for note in check(closed)} and not warnings(closed) - {"W216"}
    assert fill_holes(icosphere(1)).n_faces == 80


FAULTS = {
    "crash": ("import os, signal\nos.kill(os.getpid(), signal.SIGSEGV)", "ended by signal 11"),
    "exit": ("import os\nos._exit(0)", "it stopped"),
    "error": ("raise SystemExit('no such thing')", "no such thing"),
    "hang": ("import time\ntime.sleep(60)", "given up after"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_crash_of_pymeshlab_is_an_error_that_says_so(
    fault: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "pymeshlab.py").write_text(FAULTS[fault][0])
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(_meshlab, "SECONDS", 2 if fault == "hang" else 60)
    for run in (lambda: remesh(icosphere(1), 50), lambda: fill_holes(rectangle(3, 3))):
        with pytest.raises(MeshError, match=FAULTS[fault][1]):
            run()


def test_a_missing_extra_is_named() -> None:
    code = (
        "import sys; sys.modules['pymeshlab'] = None\n"
        "from geodesics.repair import remesh, fill_holes\nfrom geodesics import Mesh\n"
        "mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])\n"
        "for run in (lambda: remesh(mesh, 10), lambda: fill_holes(mesh)):\n"
        "    try:\n        run()\n    except ImportError as error:\n        print(type(error).__name__, error)\n"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert out.count("gmds[repair]") == 2 and out.count(MissingExtra.__name__) == 2


def test_importing_repair_does_not_import_pymeshlab() -> None:
    code = "import sys, geodesics.repair; print(sorted({'pymeshlab', 'igl', 'trimesh'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
