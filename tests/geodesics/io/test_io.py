"""Reading and writing: what is written comes back, bit for bit where the format allows, in the same order."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere, rectangle, with_isolated
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from geodesics import Mesh, MeshError, read_mesh, write_mesh

DATA = os.environ.get("GMDS_DATA", "")
EXACT = [".off", ".obj", ".ply", ".vert", ".tri", ".OFF", ".TRI"]


@st.composite
def meshes(draw: st.DrawFn) -> Mesh:
    """Any mesh the door lets in: random positions over many scales, random faces, defects included."""
    n = draw(st.integers(3, 30))
    scale = 10.0 ** draw(st.integers(-12, 12))
    unit = st.floats(-1, 1, allow_subnormal=False)
    vertices = scale * draw(hnp.arrays(np.float64, (n, 3), elements=unit))
    faces = draw(hnp.arrays(np.int64, (draw(st.integers(1, 40)), 3), elements=st.integers(0, n - 1)))
    try:
        return Mesh(vertices, faces)
    except MeshError:  # no area at all
        return icosphere(1)


@pytest.mark.parametrize("suffix", EXACT)
@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(mesh=meshes())
def test_exact_formats_keep_every_bit_and_the_order(tmp_path: Path, suffix: str, mesh: Mesh) -> None:
    write_mesh(mesh, tmp_path / f"mesh{suffix}")
    again = read_mesh(tmp_path / f"mesh{suffix}")
    assert (again.vertices + 0.0).tobytes() == (mesh.vertices + 0.0).tobytes()
    assert again.faces.tobytes() == mesh.faces.tobytes()


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(mesh=meshes())
def test_glb_keeps_the_order_in_single_precision(tmp_path: Path, mesh: Mesh) -> None:
    write_mesh(mesh, tmp_path / "mesh.glb")
    try:
        again = read_mesh(tmp_path / "mesh.glb")
    except MeshError as error:
        assert error.code == "E114"  # slivers that single precision flattens
        return
    assert np.array_equal(again.vertices, mesh.vertices.astype(np.float32))
    assert np.array_equal(again.faces, mesh.faces)


def test_stl_keeps_the_triangles_in_single_precision(tmp_path: Path) -> None:
    mesh = bumpy_sphere(2)
    write_mesh(mesh, tmp_path / "mesh.stl")
    again = read_mesh(tmp_path / "mesh.stl")
    assert (again.n_vertices, again.n_faces) == (mesh.n_vertices, mesh.n_faces)
    assert np.array_equal(again.vertices[again.faces], mesh.vertices.astype(np.float32)[mesh.faces])


@pytest.mark.parametrize("suffix", [".stl", ".glb"])
def test_what_single_precision_cannot_hold_is_refused(tmp_path: Path, suffix: str) -> None:
    big = Mesh(icosphere(1).vertices * 1e40, icosphere(1).faces)
    with pytest.raises(MeshError, match="E102"):
        write_mesh(big, tmp_path / f"mesh{suffix}")
    assert os.listdir(tmp_path) == []


def test_vertices_on_no_face_stay_in_their_rows(tmp_path: Path) -> None:
    mesh = with_isolated(icosphere(1))
    for suffix in (*EXACT, ".glb"):
        write_mesh(mesh, tmp_path / f"mesh{suffix}")
        assert read_mesh(tmp_path / f"mesh{suffix}").n_vertices == mesh.n_vertices


@pytest.mark.parametrize("suffix", [".off", ".obj", ".ply", ".stl", ".glb"])
def test_other_readers_agree(tmp_path: Path, suffix: str) -> None:
    import trimesh

    mesh = rectangle(5, 3)
    write_mesh(mesh, tmp_path / f"mesh{suffix}")
    other = trimesh.load_mesh(tmp_path / f"mesh{suffix}", process=False)
    corners = np.asarray(other.vertices)[np.asarray(other.faces)]
    assert np.abs(corners - mesh.vertices[mesh.faces]).max() < 1e-7


@pytest.mark.parametrize("suffix", [".off", ".obj", ".ply", ".stl", ".glb"])
def test_files_of_other_writers_are_read(tmp_path: Path, suffix: str) -> None:
    import trimesh

    mesh = bumpy_sphere(1)
    trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).export(tmp_path / f"mesh{suffix}")
    again = read_mesh(tmp_path / f"mesh{suffix}")
    assert np.abs(again.vertices[again.faces] - mesh.vertices[mesh.faces]).max() < 1e-6


def test_the_two_files_of_a_tosca_shape_and_their_stem(tmp_path: Path) -> None:
    mesh = icosphere(1)
    write_mesh(mesh, tmp_path / "cat0.tri")
    assert sorted(os.listdir(tmp_path)) == ["cat0.tri", "cat0.vert"]
    for name in ("cat0", "cat0.vert", "cat0.tri"):
        assert np.array_equal(read_mesh(tmp_path / name).faces, mesh.faces)
    assert (tmp_path / "cat0.tri").read_text().split()[0] == str(mesh.faces[0, 0] + 1)


def test_mesh_objects_of_others_can_be_written(tmp_path: Path) -> None:
    import trimesh

    mesh = icosphere(1)
    write_mesh(trimesh.Trimesh(mesh.vertices, mesh.faces, process=False), tmp_path / "a.off")  # type: ignore[arg-type]
    assert np.array_equal(read_mesh(tmp_path / "a.off").vertices, mesh.vertices)


def test_writing_through_a_link_or_over_a_file(tmp_path: Path) -> None:
    for mesh in (icosphere(1), icosphere(0)):
        write_mesh(mesh, tmp_path / "a.off")
        assert read_mesh(tmp_path / "a.off").n_vertices == mesh.n_vertices
    with pytest.raises(FileNotFoundError):
        write_mesh(icosphere(0), tmp_path / "missing" / "a.off")


@pytest.mark.skipif(not DATA, reason="GMDS_DATA is not set")
@pytest.mark.parametrize(
    ("name", "vertices", "faces"),
    [
        ("tosca_hires/centaur3.off", 15768, 31532),
        ("faust_5k/tr_reg_000.off", 4999, 9994),
        ("shrec20/models/cow.obj", 6935, 13866),
        ("tosca_nonrigid_3k/cat0", 3400, 6768),
    ],
)
def test_published_files(name: str, vertices: int, faces: int) -> None:
    mesh = read_mesh(Path(DATA) / name)
    assert (mesh.n_vertices, mesh.n_faces) == (vertices, faces)
