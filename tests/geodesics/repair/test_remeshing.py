"""New triangles for the same surface: remeshing and closing holes through pymeshlab, or a clear refusal."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere, jittered, joined, moved, rectangle, torus
from mesh_facts import area, warnings

from geodesics import Mesh, MeshError
from geodesics.check import check
from geodesics.errors import MissingExtra
from geodesics.repair import _meshlab
from geodesics.repair.remeshing import fill_holes, remesh
from geodesics.repair.repairing import repair


def punctured(mesh: Mesh, vertex: int = 3) -> Mesh:
    """The mesh without the faces at one vertex."""
    return repair(Mesh(mesh.vertices, mesh.faces[(mesh.faces != vertex).all(axis=1)])).mesh


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_remeshing_gives_as_many_good_triangles_as_asked(scale: float) -> None:
    pytest.importorskip("pymeshlab")
    old = moved(bumpy_sphere(3), scale)
    new = remesh(old, 900)
    assert (
        np.abs(new.vertices.max(axis=0) - old.vertices.max(axis=0)).max() < 0.1 * scale
    )  # it lies where the old one does
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


def test_remeshing_comes_close_to_the_count_also_when_that_is_hard() -> None:
    """A coarse mesh with a long boundary comes out too fine at first."""
    pytest.importorskip("pymeshlab")
    assert abs(remesh(rectangle(20, 20), 60).n_vertices / 60 - 1) < 0.15
    assert remesh(bumpy_sphere(2), 4).n_vertices < 20
    with pytest.raises(ValueError, match="at least 4, not 3"):
        remesh(bumpy_sphere(2), 3)


def test_holes_of_more_edges_than_asked_stay_open() -> None:
    pytest.importorskip("pymeshlab")
    holes = joined(punctured(icosphere(2)), punctured(icosphere(2), 100))  # 5 edges, 6 edges
    assert [fill_holes(holes, k).n_faces - holes.n_faces for k in (4, 5, 6)] == [0, 3, 7]


@pytest.mark.parametrize("scale", [1e-60, 1.0, 1e60])
def test_a_ragged_hole_is_closed_whatever_the_unit(scale: float) -> None:
    """Even where the new faces have to pass through each other."""
    pytest.importorskip("pymeshlab")
    ball = icosphere(2)
    bowl = repair(Mesh(ball.vertices, ball.faces[ball.vertices[ball.faces].mean(axis=1)[:, 2] < 0.3])).mesh
    ragged = jittered(bowl, 0.6)
    rim = next(note for note in check(ragged) if note.code == "W217")
    closed = fill_holes(Mesh(scale * ragged.vertices, ragged.faces))
    assert f"with {closed.n_faces - ragged.n_faces + 2} edges" in rim.message
    assert np.array_equal(closed.faces, fill_holes(ragged).faces)


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
    monkeypatch.setattr(_meshlab, "SECONDS", 2 if fault == "hang" else 600)
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
    assert out.count("pip install 'pymeshlab>=2023.12'") == 2 and out.count(MissingExtra.__name__) == 2


def test_importing_repair_does_not_import_pymeshlab() -> None:
    code = "import sys, geodesics.repair; print(sorted({'pymeshlab', 'igl', 'trimesh'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
