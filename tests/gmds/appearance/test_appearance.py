"""Colours and textures: read, carried along a map over seams and cuts, written for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from generated_shapes import icosphere, moved
from numpy.typing import NDArray

from geodesics import Mesh, SurfacePoints, read_mesh, write_mesh
from gmds import Correspondence
from gmds.appearance import Look, carry_uv, charts, read_look, write_look
from gmds.appearance.reading import BadLook
from gmds.errors import MapError

Array = NDArray[np.float64]
TARGET = icosphere(3)
RNG = np.random.default_rng(5)


def around(places: Array) -> Array:
    """Turns around the z axis, from 0 to 1."""
    return np.arctan2(places[..., 1], places[..., 0]) / (2 * np.pi) + 0.5


def unwrapped(mesh: Mesh) -> Array:
    """Texture coordinates (m, 3, 2) of a sphere as of a map of the world, cut along a meridian; no face is torn."""
    u = around(mesh.vertices)[mesh.faces]
    wrap = np.ptp(u, axis=1) > 0.5
    u[wrap] = np.where(u[wrap] < 0.5, u[wrap] + 1, u[wrap])
    return np.stack([u / 2, mesh.vertices[mesh.faces][..., 2]], axis=-1)


def halves(mesh: Mesh) -> Array:
    """Two charts far apart in the image: faces above and below the equator, seen from above."""
    place = mesh.vertices[mesh.faces]
    below = place[..., 2].mean(axis=1) < 0
    return place[..., :2] * 0.2 + np.where(below, 10.0, 0.0)[:, None, None]


def onto(source: Mesh) -> Correspondence:
    return Correspondence.from_points(source, SurfacePoints.closest(TARGET, source.vertices))


def longest(uv: Array) -> Array:
    return np.asarray(np.linalg.norm(uv - np.roll(uv, -1, axis=1), axis=2).max(axis=1))


@pytest.mark.parametrize("layout", [unwrapped, halves])
def test_the_identity_carries_every_corner_exactly(layout: Any) -> None:
    uv = layout(TARGET)
    carried, _ = carry_uv(onto(TARGET), uv)
    assert np.abs(carried - uv).max() < 1e-9


def test_a_face_across_a_seam_takes_all_from_one_chart() -> None:
    source = moved(icosphere(2), 0.4)
    source = Mesh(source.vertices / np.linalg.norm(source.vertices, axis=1, keepdims=True), source.faces)
    uv = halves(TARGET)
    carried, across = carry_uv(onto(source), uv)
    below = carried[..., 0] > 5
    assert (below.all(axis=1) | ~below.any(axis=1)).all()
    assert 10 < across.sum() < 0.4 * source.n_faces
    naive = np.einsum("nk,nkj->nj", onto(source).points.barycentric, uv[onto(source).points.face])[source.faces]
    assert longest(naive)[across].max() > 10 > 0.4 > longest(carried).max()
    assert np.array_equal(naive[~across], carried[~across])
    middle = source.vertices[source.faces].mean(axis=1)
    seen = carried.mean(axis=1) - np.where(below.any(axis=1), 10.0, 0.0)[:, None]
    assert np.abs(seen - 0.2 * middle[:, :2]).max() < 0.02


def test_a_cut_within_one_chart_is_not_crossed() -> None:
    source = moved(icosphere(2), 0.3)
    source = Mesh(source.vertices / np.linalg.norm(source.vertices, axis=1, keepdims=True), source.faces)
    uv = unwrapped(TARGET)
    assert charts(TARGET, uv).max() == 0
    carried, across = carry_uv(onto(source), uv)
    middle = source.vertices[source.faces].mean(axis=1)
    away = np.abs(middle[:, 2]) < 0.8 * np.linalg.norm(middle, axis=1)  # at the poles u turns by itself
    assert across[away].sum() > 3
    assert np.ptp(carried[..., 0], axis=1)[away].max() < 0.2  # across the cut it would be 0.5
    off = (2 * carried[..., 0].mean(axis=1) - around(middle) + 0.5) % 1 - 0.5
    assert np.abs(off[away]).max() < 0.06


def test_coordinates_of_another_shape_are_refused() -> None:
    with pytest.raises(MapError, match="must be finite"):
        carry_uv(onto(TARGET), np.zeros((5, 3, 2)))
    with pytest.raises(MapError, match="must be finite"):
        carry_uv(onto(TARGET), np.full((TARGET.n_faces, 3, 2), np.nan))


@pytest.mark.parametrize("ending", [".ply", ".obj", ".glb"])
@pytest.mark.parametrize("channels", [3, 4])
def test_colours_come_back(tmp_path: Path, ending: str, channels: int) -> None:
    colours = RNG.integers(0, 256, (TARGET.n_vertices, channels)).astype(np.uint8)
    path = tmp_path / f"m{ending}"
    assert write_look(path, TARGET, Look(colours)) == [path]
    mesh = read_mesh(path)
    assert np.allclose(mesh.vertices, TARGET.vertices, atol=1e-6) and np.array_equal(mesh.faces, TARGET.faces)
    again = read_look(path, mesh).colours
    assert again is not None and np.array_equal(again[:, :3], colours[:, :3])
    assert ending == ".obj" or channels == 3 or np.array_equal(again, colours)


@pytest.mark.parametrize("layout", [unwrapped, halves])
def test_textures_come_back_to_the_corners(tmp_path: Path, layout: Any) -> None:
    image_of = pytest.importorskip("PIL.Image")
    pixels = RNG.integers(0, 256, (16, 8, 3)).astype(np.uint8)
    look = Look(uv=layout(TARGET), image=image_of.fromarray(pixels))
    files = write_look(tmp_path / "a b.obj", TARGET, look)
    assert sorted(path.name for path in files) == ["a b.obj", "a_b.mtl", "a_b.png"]
    assert "map_Kd a_b.png" in (tmp_path / "a_b.mtl").read_text()
    mesh = read_mesh(tmp_path / "a b.obj")
    assert np.array_equal(mesh.vertices, TARGET.vertices)
    again = read_look(tmp_path / "a b.obj", mesh)
    assert again.image is None and again.uv is not None and np.abs(again.uv - look.uv).max() < 1e-9
    named = read_look(tmp_path / "a b.obj", mesh, tmp_path / "a_b.png")
    assert np.array_equal(np.asarray(named.image), pixels)
    write_look(tmp_path / "m.glb", TARGET, look)
    inside = read_look(tmp_path / "m.glb", TARGET)  # of the mesh that is not cut open along the seams
    assert inside.uv is not None and np.abs(inside.uv - look.uv).max() < 1e-6
    assert np.array_equal(np.asarray(inside.image), pixels)
    assert read_mesh(tmp_path / "m.glb").n_vertices > TARGET.n_vertices


def test_what_other_programs_read(tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    values = {
        "value": RNG.standard_normal((TARGET.n_vertices, 3)),
        "count": np.arange(TARGET.n_vertices),
        "valid": np.arange(TARGET.n_vertices) % 2 == 0,
    }
    colours = RNG.integers(0, 256, (TARGET.n_vertices, 3)).astype(np.uint8)
    for ending in (".vtp", ".ply"):
        write_look(tmp_path / f"m{ending}", TARGET, Look(colours), values)
    read = pyvista.read(tmp_path / "m.vtp")
    assert np.array_equal(read.points, TARGET.vertices)
    assert np.array_equal(read.faces.reshape(-1, 4)[:, 1:], TARGET.faces)
    assert np.array_equal(read.point_data["colours"], colours)
    assert all(np.array_equal(read.point_data[name], array) for name, array in values.items())
    again = read_mesh(tmp_path / "m.ply")
    assert np.array_equal(again.vertices, TARGET.vertices) and np.array_equal(again.faces, TARGET.faces)
    header = (tmp_path / "m.ply").read_bytes().split(b"end_header")[0].decode()
    assert all(f"property {one}\n" in header for one in ("double value_2", "int count", "uchar valid", "uchar red"))


def test_what_a_format_can_not_keep_is_refused(tmp_path: Path) -> None:
    textured = Look(uv=unwrapped(TARGET))
    cases: list[tuple[str, Look, dict[str, Any], str]] = [
        ("m.ply", textured, {}, "in .obj or .glb"),
        ("m.obj", Look(), {"v": np.zeros(TARGET.n_vertices)}, "in .ply or .vtp"),
        ("m.vtp", Look(), {"v": np.array(["a"] * TARGET.n_vertices)}, "holds words"),
    ]
    for name, look, values, told in cases:
        with pytest.raises(BadLook, match=told):
            write_look(tmp_path / name, TARGET, look, values)
        assert not (tmp_path / name).exists()


def test_files_whose_look_can_not_be_used(tmp_path: Path) -> None:
    write_mesh(TARGET, tmp_path / "m.ply")
    assert read_look(tmp_path / "m.ply", TARGET).colours is None
    write_mesh(TARGET, tmp_path / "m.off")
    assert read_look(tmp_path / "m.off", TARGET).uv is None
    with pytest.raises(BadLook, match="give a file of the same faces"):
        read_look(tmp_path / "m.ply", icosphere(2))
    write_look(tmp_path / "m.obj", TARGET, Look(uv=unwrapped(TARGET)))
    pytest.importorskip("PIL")
    (tmp_path / "no.png").write_bytes(b"\x89PNG no")
    with pytest.raises(BadLook, match=r"no.png is no image"):
        read_look(tmp_path / "m.obj", TARGET, tmp_path / "no.png")


def test_no_file_is_opened_that_was_not_named(tmp_path: Path) -> None:
    write_look(tmp_path / "m.obj", TARGET, Look(uv=unwrapped(TARGET)))
    trap = tmp_path / "trap.mtl"
    trap.write_text("newmtl x\nmap_Kd trap.png\n")
    path = tmp_path / "m.obj"
    path.write_text("mtllib trap.mtl\nusemtl x\n" + path.read_text())
    trap.chmod(0)
    assert read_look(path, TARGET).image is None
