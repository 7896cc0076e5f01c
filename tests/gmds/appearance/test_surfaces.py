"""Looks of files that are not one list of triangles with one material."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from file_cases import F_TEXT, PLY_HEAD, V_TEXT, F, V, glb
from other_formats import halves, with_bytes

from geodesics import read_mesh
from gmds.appearance import read_look
from gmds.appearance.reading import BadLook

QUAD = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0.5 1\n"
UV = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\n"
HERE = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]])


def look_of(path: Path, content: str | bytes) -> Any:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_look(path, read_mesh(path))


@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize("materials", [1, 2])
def test_corners_of_polygons_keep_their_coordinates(tmp_path: Path, back: bool, materials: int) -> None:
    faces = [[4, 3, 2, 1], [2, 3, 5]]
    lines = [" ".join(f"{i - 6 * back}/{i - 6 * back}" for i in face) for face in faces]
    use = "usemtl skin\n", "usemtl eyes\n" if materials == 2 else ""
    look = look_of(tmp_path / "a.obj", f"{QUAD}{UV}{use[0]}f {lines[0]}\n{use[1]}f {lines[1]}\n")
    assert np.array_equal(look.uv, HERE[[[3, 2, 1], [3, 1, 0], [1, 2, 4]]])
    assert bool(look.notes) == (materials == 2) and all("skin, eyes" in told for told in look.notes)


def test_a_concave_polygon_keeps_its_coordinates(tmp_path: Path) -> None:
    points = np.array([(1, 2), (0, 2), (0, 0), (2, 0), (2, 1), (1, 1)])
    text = "".join(f"v {x} {y} 0\nvt {x / 4} {y / 4}\n" for x, y in points.tolist())
    look = look_of(tmp_path / "a.obj", text + "f 1/1 2/2 3/3 4/4 5/5 6/6\n")
    mesh = read_mesh(tmp_path / "a.obj")
    assert np.allclose(look.uv, mesh.vertices[mesh.faces][:, :, :2] / 4)


def test_corners_without_a_coordinate(tmp_path: Path) -> None:
    look = look_of(tmp_path / "a.obj", f"{QUAD}{UV}f 1/1 2/2 3/3\nf 2 3 5\n")
    assert np.array_equal(look.uv, [HERE[:3], np.zeros((3, 2))])


def test_colours_of_a_mesh_of_quads(tmp_path: Path) -> None:
    lines = [f"{line} 1 0.5 0" for line in QUAD.splitlines()]
    look = look_of(tmp_path / "a.obj", "\n".join(lines) + "\nf 1 2 3 4\nf 2 5 3\n")
    assert look.colours.tolist() == [[255, 128, 0]] * 5


@pytest.mark.parametrize("binary", [False, True])
def test_coordinates_in_a_ply(tmp_path: Path, binary: bool) -> None:
    at_vertex = PLY_HEAD.replace("float z", "float z\nproperty float s\nproperty float t")
    rows = "".join(f"{line} {i / 4} {i / 8}\n" for i, line in enumerate(V_TEXT.splitlines()))
    look = look_of(tmp_path / "a.ply", at_vertex + rows + F_TEXT)
    assert np.array_equal(look.uv, np.column_stack([np.arange(4) / 4, np.arange(4) / 8])[F])
    wedges = np.arange(24.0).reshape(4, 3, 2)
    head = PLY_HEAD.replace("indices\n", "indices\nproperty list uchar float texcoord\n")
    if binary:
        faces = np.empty(4, dtype=[("n", "u1"), ("f", "<i4", 3), ("k", "u1"), ("t", "<f4", 6)])
        faces["n"], faces["f"], faces["k"], faces["t"] = 3, F, 6, wedges.reshape(4, 6)
        content = head.replace("ascii", "binary_little_endian").encode() + V.astype("<f4").tobytes() + faces.tobytes()
    else:
        lines = zip(F_TEXT.splitlines(), wedges.reshape(4, 6).tolist(), strict=True)
        content = (head + V_TEXT + "".join(f"{face} 6 {' '.join(map(str, t))}\n" for face, t in lines)).encode()
    assert np.array_equal(look_of(tmp_path / "b.ply", content).uv, wedges)


def test_a_scene_of_several_parts(tmp_path: Path) -> None:
    def change(tree: Any) -> None:
        halves(tree)
        for primitive in tree["meshes"][0]["primitives"]:
            primitive["attributes"]["TEXCOORD_0"] = 3
        tree["accessors"].append({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"})
        tree["bufferViews"].append({"buffer": 0, "byteOffset": 72, "byteLength": 32})

    there = HERE[:4].astype("<f4")
    look = look_of(tmp_path / "a.glb", with_bytes(glb(change), there.tobytes()))
    assert np.array_equal(look.uv, (there * (1, -1) + (0, 1))[F]) and look.image is None


def test_a_file_of_other_faces(tmp_path: Path) -> None:
    (tmp_path / "a.ply").write_text(PLY_HEAD + V_TEXT + F_TEXT)
    turned = "".join(F_TEXT.splitlines(keepends=True)[::-1])
    (tmp_path / "b.ply").write_text(PLY_HEAD + V_TEXT + turned)
    with pytest.raises(BadLook, match=r"E217.*in another order"):
        read_look(tmp_path / "b.ply", read_mesh(tmp_path / "a.ply"))
