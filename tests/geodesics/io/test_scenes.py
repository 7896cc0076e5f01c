"""Scenes of glTF as one mesh: every part in its place, the right side out, and known by its name."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from file_cases import F, V, glb, setting
from other_formats import gltf, halves, mirrored, quantised, with_bytes

from geodesics import FormatError, Mesh, read_mesh, read_with_notes
from geodesics.io import read_parts


def volume(mesh: Mesh) -> float:
    a, b, c = mesh.vertices[mesh.faces.T]
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def twice(tree: Any) -> None:
    tree["nodes"] = [{"mesh": 0, "name": "here"}, {"mesh": 0, "translation": [5, 0, 0], "scale": [2, 2, 2]}]
    tree["scenes"][0]["nodes"] = [0, 1]


def without_indices(tree: Any) -> None:
    tree["meshes"][0]["primitives"][0].pop("indices")
    tree["accessors"][0]["count"] = 3


def read(tmp_path: Path, content: bytes, name: str = "a.glb") -> Mesh:
    (tmp_path / name).write_bytes(content)
    return read_mesh(tmp_path / name)


def test_a_mesh_is_there_as_often_as_it_is_placed(tmp_path: Path) -> None:
    mesh = read(tmp_path, glb(twice))
    assert np.allclose(mesh.vertices, np.vstack([V, 2 * V + (5, 0, 0)]))
    assert np.array_equal(mesh.faces, np.vstack([F, F + 4]))
    parts = read_parts(tmp_path / "a.glb")
    assert [(part.name, part.vertices, part.faces) for part in parts] == [
        ("here", range(4), range(4)),
        ("", range(4, 8), range(4, 8)),
    ]
    notes = read_with_notes(tmp_path / "a.glb")[1]
    assert [(note.code, note.count) for note in notes] == [("W222", 2)]


def test_primitives_that_share_positions_share_vertices(tmp_path: Path) -> None:
    mesh = read(tmp_path, glb(halves))
    assert np.array_equal(mesh.vertices, V) and np.array_equal(mesh.faces, F)
    parts = read_parts(tmp_path / "a.glb")
    assert [(part.material, part.faces) for part in parts] == [("", range(2)), ("skin", range(2, 4))]
    assert [note.code for note in read_with_notes(tmp_path / "a.glb")[1]] == ["W222", "W223"]


def test_a_file_of_one_piece_has_no_parts(tmp_path: Path) -> None:
    read(tmp_path, glb())
    assert read_parts(tmp_path / "a.glb") == []


@pytest.mark.parametrize("scale", [(-1, 1, 1), (-2, -1, -1), (-1, -1, 1), (1, 2, 3)])
def test_what_was_outside_stays_outside(tmp_path: Path, scale: tuple[int, ...]) -> None:
    mesh = read(tmp_path, glb(setting("nodes", 0, "scale", value=scale)))
    assert np.allclose(mesh.vertices, V * scale)
    assert np.sign(volume(mesh)) == np.sign(volume(Mesh(V, F)))
    assert abs(volume(mesh)) == pytest.approx(abs(volume(Mesh(V, F)) * np.prod(scale)))


def test_a_mirror_above_another_node(tmp_path: Path) -> None:
    mesh = read(tmp_path, glb(mirrored))
    assert np.allclose(mesh.vertices, V * (-1, 1, 1)) and np.array_equal(mesh.faces, F[:, ::-1])


@pytest.mark.parametrize(("kind", "largest"), [("i1", 127), ("u1", 255), ("<i2", 32767), ("<u2", 65535)])
def test_quantised_positions_are_fractions(tmp_path: Path, kind: str, largest: int) -> None:
    unsigned = "u" in kind
    numbers = (V + 1) / 2 * largest if unsigned else V * largest

    def change(tree: Any) -> None:
        quantised(tree)
        tree["accessors"][0]["componentType"] = {"i1": 5120, "u1": 5121, "<i2": 5122, "<u2": 5123}[kind]
        tree["nodes"][0] |= {"scale": [3, 3, 3], "translation": [1, 2, 3]}

    mesh = read(tmp_path, glb(change, kinds=(kind, "<u2"), v=np.rint(numbers)))
    assert np.abs(mesh.vertices - (3 * ((V + 1) / 2 if unsigned else V) + (1, 2, 3))).max() < 3 / largest


def test_strides_and_strips_and_fans(tmp_path: Path) -> None:
    def change(mode: int) -> Any:
        def edit(tree: Any) -> None:
            tree["meshes"][0]["primitives"][0]["mode"] = mode
            tree["accessors"][1] |= {"count": 4, "bufferView": 2, "byteOffset": 4}
            tree["bufferViews"].append({"buffer": 0, "byteOffset": 72, "byteLength": 20, "byteStride": 4})
            tree["buffers"][0]["byteLength"] = 92

        return edit

    order = np.zeros((5, 2), "<u2")
    order[1:, 0] = [2, 0, 1, 3]
    strip = read(tmp_path, with_bytes(glb(change(5)), order.tobytes()))
    assert strip.faces.tolist() == [[2, 0, 1], [1, 0, 3]]
    fan = read(tmp_path, with_bytes(glb(change(6)), order.tobytes()))
    assert fan.faces.tolist() == [[2, 0, 1], [2, 1, 3]]


def test_corners_that_stand_alone_make_triangles(tmp_path: Path) -> None:
    assert read(tmp_path, glb(without_indices)).faces.tolist() == [[0, 1, 2]]


def test_a_skin_poses_the_surface_and_its_node_does_not(tmp_path: Path) -> None:
    joints = np.zeros((4, 4), "u1")
    joints[2:, 0] = 1
    weights = np.zeros((4, 4), "<f4")
    weights[:3, 0] = 0.5  # rows are brought to sum 1; the last vertex has none, and stays with its node

    def change(tree: Any) -> None:
        tree["nodes"] = [{"mesh": 0, "skin": 0, "translation": [9, 9, 9]}, {"translation": [0, 0, 5]}, {}]
        tree["scenes"][0]["nodes"] = [0, 1, 2]
        tree["skins"] = [{"joints": [1, 2]}]
        tree["meshes"][0]["primitives"][0]["attributes"] |= {"JOINTS_0": 2, "WEIGHTS_0": 3}
        tree["accessors"] += [
            {"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC4"},
            {"bufferView": 2, "byteOffset": 16, "componentType": 5126, "count": 4, "type": "VEC4"},
        ]
        tree["bufferViews"].append({"buffer": 0, "byteOffset": 72, "byteLength": 80})

    mesh = read(tmp_path, with_bytes(glb(change), joints.tobytes() + weights.tobytes()))
    assert np.allclose(mesh.vertices - V, [(0, 0, 5), (0, 0, 5), (0, 0, 0), (9, 9, 9)])


def test_morph_targets_count_as_far_as_they_are_turned_on(tmp_path: Path) -> None:
    def change(tree: Any) -> None:
        tree["meshes"][0] |= {"weights": [0.5, 0.0]}
        tree["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 0}, {"NORMAL": 0}]

    assert np.allclose(read(tmp_path, glb(change)).vertices, 1.5 * V)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (setting("meshes", 0, "primitives", 0, "extensions", value={"KHR_draco_mesh_compression": {}}), "Draco"),
        (setting("bufferViews", 0, "extensions", value={"EXT_meshopt_compression": {}}), "meshopt"),
        (setting("nodes", 0, "extensions", value={"EXT_mesh_gpu_instancing": {}}), "EXT_mesh_gpu_instancing"),
    ],
)
def test_what_is_compressed_or_copied_in_ways_not_known_is_named(tmp_path: Path, change: Any, says: str) -> None:
    def edit(tree: Any) -> None:
        change(tree)
        if says == "Draco":
            tree["accessors"][0].pop("bufferView")
        if says == "meshopt":
            tree["buffers"][0] |= {"extensions": {"EXT_meshopt_compression": {"fallback": True}}}

    with pytest.raises(FormatError, match=f"E209.*{says}"):
        read(tmp_path, glb(edit))


def test_a_scene_of_countless_copies_is_refused_before_it_is_made(tmp_path: Path) -> None:
    def change(tree: Any) -> None:
        tree["nodes"] = [{"mesh": 0}] * 30_000
        tree["scenes"][0]["nodes"] = list(range(30_000))
        tree["accessors"][0] = {"componentType": 5126, "count": 1 << 16, "type": "VEC3"}

    with pytest.raises(FormatError, match="E221"):
        read(tmp_path, glb(change))


def test_a_gltf_with_numbers_in_another_file(tmp_path: Path) -> None:
    tree = json.loads(gltf())
    tree["buffers"][0]["uri"] = "data.bin"
    with pytest.raises(FormatError, match="E222"):
        read(tmp_path, json.dumps(tree).encode(), "a.gltf")
