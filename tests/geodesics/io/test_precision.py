"""What rounding does to shapes that lie far from the origin is told (W208, W224), and avoided where a format can."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from generated_shapes import bumpy_sphere, icosphere, rectangle

from geodesics import Mesh, read_mesh, write_mesh
from geodesics.check import check
from geodesics.io.precision import granularity
from gmds import match
from gmds.cli import main

FAR = np.array([431_000.25, 5_412_000.5, 300.0])  # metres of a surveyor's grid


def moved(mesh: Mesh, by: np.ndarray, rounded: object = np.float64, scale: float = 1.0) -> Mesh:
    return Mesh((scale * (mesh.vertices + by)).astype(rounded).astype(np.float64), mesh.faces)  # type: ignore[call-overload]


def codes(mesh: Mesh) -> set[str]:
    return {note.code for note in check(mesh)}


@pytest.mark.parametrize("scale", [1.0, 1e-3, 1e6])
@pytest.mark.parametrize("mesh", [bumpy_sphere(3), rectangle(20, 20)])
def test_single_precision_far_away(mesh: Mesh, scale: float) -> None:
    assert "W208" in codes(moved(mesh, FAR, np.float32, scale))
    assert "W208" not in codes(moved(mesh, FAR, scale=scale))
    assert "W208" not in codes(moved(mesh, np.zeros(3), np.float32, scale))
    assert "W208" not in codes(moved(mesh, np.array([30.0, 0, 0]), np.float32, scale)), "near enough"


@pytest.mark.parametrize("digits", [6, 7])
def test_few_digits_far_away(digits: int) -> None:
    far = moved(bumpy_sphere(3), FAR)
    printed = np.array([[float(f"{x:.{digits}g}") for x in row] for row in far.vertices])
    assert "W208" in codes(Mesh(printed, far.faces))
    near = np.array([[float(f"{x:.{digits}g}") for x in row] for row in bumpy_sphere(3).vertices])
    assert "W208" not in codes(Mesh(near, far.faces))


def test_matching_tells_it_too() -> None:
    mesh = bumpy_sphere(2)
    notes = match(moved(mesh, FAR, np.float32), mesh).meta["notes"]
    assert [note for note in notes if "W208: the source: " in note] and not [
        n for n in notes if "W208: the target" in n
    ]


def test_granularity() -> None:
    mesh = icosphere(1)
    assert granularity(mesh) == 0
    assert granularity(moved(mesh, FAR, np.float32)) == np.spacing(np.float32(FAR[1]))
    assert granularity(Mesh(np.round(mesh.vertices, 3), mesh.faces)) == pytest.approx(1e-3)


@pytest.mark.parametrize("suffix", [".glb", ".stl", ".ply"])
@pytest.mark.parametrize("far", [False, True])
def test_what_writing_does_to_vertices_is_told(tmp_path: Path, suffix: str, far: bool) -> None:
    mesh = moved(bumpy_sphere(3), FAR) if far else bumpy_sphere(3)
    write_mesh(mesh, tmp_path / "a.ply")
    result = CliRunner().invoke(main, ["repair", str(tmp_path / "a.ply"), "-o", str(tmp_path / f"b{suffix}")])
    assert result.exit_code == 0, result.output
    assert ("W224" in result.output) == (far and suffix != ".ply"), result.output
    again = read_mesh(tmp_path / f"b{suffix}")
    error = np.abs(again.vertices[again.faces] - mesh.vertices[mesh.faces]).max()
    assert error < (1e-12 if suffix == ".ply" else 1 if far and suffix == ".stl" else 1e-6)
    if far and suffix == ".stl":
        assert error > 0.1


def test_a_scene_far_away_is_where_it_was_for_others(tmp_path: Path) -> None:
    import trimesh

    mesh = moved(bumpy_sphere(2), FAR)
    notes = write_mesh(mesh, tmp_path / "a.glb")
    assert [(note.code, note.severity) for note in notes] == [("W224", "info")]
    other = trimesh.load_mesh(tmp_path / "a.glb", process=False)
    assert np.abs(np.asarray(other.vertices) - mesh.vertices).max() < 1
