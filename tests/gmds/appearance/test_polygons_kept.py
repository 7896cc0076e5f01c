"""Polygons of a file are written as they were, wherever the format has polygons."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from file_cases import glb
from generated_shapes import icosphere

from geodesics import Mesh, SurfacePoints, read_mesh, write_mesh
from geodesics.io.reading import contents_of
from gmds import Correspondence
from gmds.appearance import Look, polygons_of, read_look, write_look
from gmds.cli import main

# Two quads, a triangle, a concave hexagon, and an edge that is no face.
TEXT = """v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 3 0 0\nv 5 0 0\nv 5 2 0\nv 4 2 0\nv 4 1 0\nv 3 1 0
f 1 2 3 4\nf 2 5 6 3\nf 5 7 6\nf 1 2\nf 8 9 10 11 12 7\n"""
FACES = [[0, 1, 2, 3], [1, 4, 5, 2], [4, 6, 5], [7, 8, 9, 10, 11, 6]]


def listed(path: Path) -> list[list[int]]:
    sizes, corners = contents_of(path).polygons
    return [part.tolist() for part in np.split(corners, np.cumsum(sizes)[:-1])]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "a.obj").write_text(TEXT)
    return tmp_path / "a.obj"


@pytest.mark.parametrize("ending", [".obj", ".ply", ".vtp"])
def test_polygons_come_back(tmp_path: Path, file: Path, ending: str) -> None:
    mesh = read_mesh(file)
    colours = np.arange(3 * mesh.n_vertices, dtype=np.uint8).reshape(-1, 3)
    write_look(tmp_path / f"b{ending}", mesh, Look(colours), polygons=polygons_of(file, mesh))
    again = read_mesh(tmp_path / f"b{ending}")
    assert listed(tmp_path / f"b{ending}") == FACES
    assert np.array_equal(again.vertices, mesh.vertices) and np.array_equal(again.faces, mesh.faces)
    if ending != ".vtp":
        assert np.array_equal(read_look(tmp_path / f"b{ending}", again).colours, colours)


def test_polygons_larger_than_a_byte_counts(tmp_path: Path) -> None:
    angle = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    lines = [f"v {x} {y} 0" for x, y in zip(np.cos(angle), np.sin(angle), strict=True)]
    (tmp_path / "a.obj").write_text("\n".join([*lines, "f " + " ".join(map(str, range(1, 301))), ""]))
    mesh = read_mesh(tmp_path / "a.obj")
    write_look(tmp_path / "b.ply", mesh, Look(), {"x": angle}, polygons_of(tmp_path / "a.obj", mesh))
    assert listed(tmp_path / "b.ply") == [list(range(300))]


@pytest.mark.parametrize("torn", [False, True])
def test_a_polygon_across_a_seam_is_split_and_no_other(tmp_path: Path, file: Path, torn: bool) -> None:
    mesh = read_mesh(file)
    uv = mesh.vertices[mesh.faces][:, :, :2] / 8
    uv[1] += 0.5 * torn  # the second triangle of the first quad
    write_look(tmp_path / "b.obj", mesh, Look(uv=uv), polygons=polygons_of(file, mesh))
    assert listed(tmp_path / "b.obj") == ([[0, 1, 2], [0, 2, 3], *FACES[1:]] if torn else FACES)
    again = read_mesh(tmp_path / "b.obj")
    assert np.array_equal(again.faces, mesh.faces)
    assert np.array_equal(read_look(tmp_path / "b.obj", again).uv, uv)


def test_files_of_triangles_or_of_another_mesh_have_none(tmp_path: Path, file: Path) -> None:
    write_mesh(icosphere(0), tmp_path / "b.obj")
    (tmp_path / "c.glb").write_bytes(glb())
    assert polygons_of(tmp_path / "b.obj", icosphere(0)) is None
    assert polygons_of(tmp_path / "c.glb", read_mesh(tmp_path / "c.glb")) is None
    assert polygons_of(file, icosphere(0)) is None


@pytest.mark.parametrize("ending", [".obj", ".ply", ".vtp", ".glb"])
@pytest.mark.parametrize("kind", ["values", "look", "texture"])
@pytest.mark.parametrize("origin", [".obj", ".ply"])
def test_transfer_keeps_polygons_of_the_source_or_says_that_it_does_not(
    tmp_path: Path, ending: str, kind: str, origin: str, file: Path
) -> None:
    mesh = read_mesh(file)
    source = tmp_path / f"source{origin}"
    write_look(source, mesh, Look(), polygons=polygons_of(file, mesh))
    target = Mesh(mesh.vertices, mesh.faces)
    if kind == "texture":
        write_look(tmp_path / "t.obj", target, Look(uv=mesh.vertices[mesh.faces][:, :, :2] / 8))
    else:
        write_look(tmp_path / "t.obj", target, Look(np.full((mesh.n_vertices, 3), 9, dtype=np.uint8)))
    at = SurfacePoints.at_vertices(target, np.arange(mesh.n_vertices))
    Correspondence.from_points(mesh, at).save(tmp_path / "m.npz")
    np.savetxt(tmp_path / "v.txt", np.full((mesh.n_vertices, 3), 7), fmt="%d")
    arguments = [str(tmp_path / "m.npz"), "--source", str(source), "--target", str(tmp_path / "t.obj")]
    arguments += ["--values", str(tmp_path / "v.txt"), "--kind", "colours"] if kind == "values" else []
    result = CliRunner().invoke(main, ["transfer", *arguments, "-o", str(tmp_path / f"out{ending}")])
    if kind == "texture" and ending in (".ply", ".vtp"):
        assert result.exit_code == 1 and "E217" in result.output
        return
    assert result.exit_code == 0, result.output
    assert ("polygons of more" in result.output) == (ending == ".glb"), result.output
    if ending != ".glb":
        assert listed(tmp_path / f"out{ending}") == FACES
