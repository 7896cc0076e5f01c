"""Rigged characters along a map: the same body keeps all it has, a moved one gets it moved, and rest is rest."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from rigged import BODY, SHAPES, character, displacements, joints_of, weights_of
from scipy.spatial.transform import Rotation

from geodesics import Mesh, SurfacePoints, read_mesh, write_mesh
from geodesics.io import read_parts
from geodesics.io.gltf_accessor import read_accessor
from geodesics.io.gltf_container import Gltf, open_gltf
from geodesics.io.gltf_nodes import placed_meshes, skin_of, world_matrices
from gmds.appearance.keeping import not_kept
from gmds.appearance.reading import BadLook
from gmds.characters import carry_scene
from gmds.characters.writing import heaviest
from gmds.cli import main
from gmds.correspondence import Correspondence

TURN = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()
EXTENT = float(np.ptp(BODY.vertices, axis=0).max())
NEAR = 1e-5 * EXTENT


def identity(source: Mesh, target: Mesh) -> Correspondence:
    return Correspondence.from_points(source, SurfacePoints.closest(target, target.vertices))


def onto(tmp_path: Path, content: bytes, source: Mesh | None = None, **options: Any) -> tuple[Mesh, Gltf, Any]:
    """What comes of carrying a character to a mesh of the same vertices: as it is read, and described; what is told."""
    file, out = tmp_path / "character.glb", tmp_path / "new.glb"
    file.write_bytes(content)
    target = read_mesh(file)
    written, told = carry_scene(identity(source or target, target), file, **options)
    out.write_bytes(written)
    return read_mesh(out), open_gltf(written, out), told


def attribute(gltf: Gltf, name: str, kind: str) -> np.ndarray:
    return read_accessor(gltf, gltf.tree["meshes"][0]["primitives"][0]["attributes"][name], kind)


def weights_in(gltf: Gltf) -> np.ndarray:
    """Weights (n, joints) of the first primitive."""
    place = next(placed_meshes(gltf))
    joint, share = skin_of(gltf, place, place.mesh["primitives"][0], attribute(gltf, "POSITION", "VEC3"))
    result = np.zeros((len(joint), len(gltf.tree["skins"][0]["joints"])))
    np.add.at(result, (np.arange(len(joint))[:, None], joint), share)
    return result


def test_the_same_body_keeps_all_it_has(tmp_path: Path) -> None:
    mesh, new, told = onto(tmp_path, character())
    old = open_gltf(character(), tmp_path / "character.glb")
    assert np.abs(mesh.vertices - BODY.vertices).max() < NEAR
    for name in ("nodes", "materials", "textures", "scenes"):
        assert new.tree[name] == old.tree[name]
    assert new.tree["skins"][0]["joints"] == [1, 2, 3] and new.tree["skins"][0]["name"] == "rig"
    assert new.tree["meshes"][0]["name"] == "BodyMesh"
    assert new.tree["meshes"][0]["extras"] == {"targetNames": list(SHAPES)}
    for index in range(2):
        content = [file.bytes_of_view(file.tree["images"][index]["bufferView"], "")[0] for file in (old, new)]
        assert content[0] == content[1]
    assert np.allclose(weights_in(new), weights_of(BODY), atol=1e-6)
    for target, shape in zip(new.tree["meshes"][0]["primitives"][0]["targets"], displacements(BODY), strict=True):
        assert np.abs(read_accessor(new, target["POSITION"], "VEC3") - shape).max() < NEAR
    assert [part.material for part in read_parts(tmp_path / "new.glb")] == ["fur", "eyes"]
    faces = [len(part.faces) for part in read_parts(tmp_path / "character.glb")]
    assert [len(part.faces) for part in read_parts(tmp_path / "new.glb")] == faces
    assert (told.parts, told.materials, told.bones, told.shapes) == (["Body"], ["fur", "eyes"], 3, 2)


@pytest.mark.parametrize("size", [1.0, 1000.0])
def test_a_moved_body_gets_the_skeleton_and_the_shapes_moved(tmp_path: Path, size: float) -> None:
    faces = read_mesh_of(tmp_path, character()).faces
    source = Mesh(size * BODY.vertices @ TURN.T + size * np.array([3.0, 1.0, 2.0]), faces)
    mesh, new, _ = onto(tmp_path, character(), source)
    assert np.abs(mesh.vertices - source.vertices)[np.unique(source.faces)].max() < size * NEAR
    worlds = world_matrices(new)
    for node, joint in zip([1, 2, 3], joints_of(BODY), strict=True):
        assert np.abs(worlds[node][:3, 3] - size * (TURN @ joint + (3, 1, 2))).max() < size * NEAR
        assert np.allclose(worlds[node][:3, :3], TURN, atol=1e-5)
    hat = joints_of(BODY)[2] + (0, 0, 0.1)
    assert np.abs(worlds[5][:3, 3] - size * (TURN @ hat + (3, 1, 2))).max() < size * NEAR
    target = new.tree["meshes"][0]["primitives"][0]["targets"]
    for one, shape in zip(target, displacements(BODY), strict=True):
        there = read_accessor(new, one["POSITION"], "VEC3")
        assert np.abs(there - size * shape @ TURN.T).max() < size * NEAR


def read_mesh_of(tmp_path: Path, content: bytes) -> Mesh:
    (tmp_path / "some.glb").write_bytes(content)
    return read_mesh(tmp_path / "some.glb")


def test_a_pose_that_is_not_that_of_binding_is_the_rest_of_the_new_one(tmp_path: Path) -> None:
    def half_on(tree: Any) -> None:
        tree["meshes"][0]["weights"] = [0.5, 0.0]

    content = character(change=half_on, pose=True)
    target = read_mesh_of(tmp_path, content)
    assert np.abs(target.vertices - BODY.vertices).max() > 0.05 * EXTENT
    mesh, new, _ = onto(tmp_path, content)
    assert np.abs(mesh.vertices - target.vertices).max() < NEAR  # skinned, with the shape half on
    assert new.tree["meshes"][0]["weights"] == [0.5, 0.0]
    (place,) = placed_meshes(new)
    assert place.joints is not None and np.allclose(place.joints, np.eye(4), atol=1e-5)


def test_other_triangles_get_weights_that_sum_to_one(tmp_path: Path) -> None:
    target = read_mesh_of(tmp_path, character())
    rng = np.random.default_rng(2)
    points = SurfacePoints(target, np.arange(target.n_faces), rng.dirichlet(np.ones(3), target.n_faces))
    source = Mesh(points.positions, np.arange(target.n_faces // 3 * 3).reshape(-1, 3))
    content, _ = carry_scene(Correspondence.from_points(source, points), tmp_path / "some.glb")
    new = open_gltf(content, tmp_path / "new.glb")
    given = read_accessor(new, new.tree["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"], "VEC4")
    assert np.allclose(given.sum(axis=1), 1, atol=1e-6) and (given >= 0).all()
    (tmp_path / "new.glb").write_bytes(content)
    back = read_mesh(tmp_path / "new.glb")
    a, b = back.vertices[back.faces], source.vertices[source.faces]
    assert np.abs(np.sort(a.mean(axis=1), axis=0) - np.sort(b.mean(axis=1), axis=0)).max() < NEAR


def test_no_vertex_hangs_on_more_than_four_bones() -> None:
    weights = np.random.default_rng(3).dirichlet(np.ones(300), 20)
    joints, share = heaviest(weights)
    assert joints.dtype == np.uint16 and np.allclose(share.sum(axis=1), 1, atol=1e-6)
    assert np.array_equal(joints[:, 0], weights.argmax(axis=1))
    joints, share = heaviest(np.array([[0.0, 1.0], [0.5, 0.5]]))
    assert joints.dtype == np.uint8 and joints.tolist() == [[1, 0, 0, 0], [0, 1, 0, 0]]
    assert share.tolist() == [[1, 0, 0, 0], [0.5, 0.5, 0, 0]]


def test_a_part_on_a_node_hangs_on_that_node_and_keeps_its_name(tmp_path: Path) -> None:
    def with_eyes(tree: Any) -> None:
        second = tree["meshes"][0]["primitives"].pop()
        bare = {name: index for name, index in second["attributes"].items() if name in ("POSITION", "TEXCOORD_0")}
        tree["meshes"].append({"name": "EyesMesh", "primitives": [{**second, "attributes": bare, "targets": []}]})
        tree["meshes"][1]["primitives"][0].pop("targets")
        tree["nodes"].append({"name": "Eyes", "mesh": 1})
        tree["nodes"][3]["children"].append(6)
        tree["nodes"][6]["translation"] = (-joints_of(BODY)[2]).tolist()  # back to where it is in the scene

    content = character(change=with_eyes)
    target = read_mesh_of(tmp_path, content)
    mesh, new, told = onto(tmp_path, content)
    assert sorted(told.parts) == ["Body", "Eyes"]
    for name in told.parts:
        places = []
        for shape, file in ((target, "character.glb"), (mesh, "new.glb")):
            part = next(part for part in read_parts(tmp_path / file) if part.name == name)
            places.append(shape.vertices[shape.faces[part.faces.start : part.faces.stop]])
        assert np.abs(places[0] - places[1]).max() < NEAR
    assert sorted(mesh["name"] for mesh in new.tree["meshes"]) == ["BodyMesh", "EyesMesh"]
    assert new.tree["skins"][0]["joints"] == [1, 2, 3, 6]


def test_another_reader_has_the_same(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    onto(tmp_path, character())
    scene = trimesh.load(tmp_path / "new.glb")
    shapes = list(scene.geometry.values())
    assert [shape.visual.material.name for shape in shapes] == ["fur", "eyes"]
    colours = [shape.visual.material.baseColorTexture.getpixel((0, 0)) for shape in shapes]
    assert colours == [(200, 90, 10), (10, 90, 200)]
    assert sum(len(shape.faces) for shape in shapes) == BODY.n_faces


def test_materials_alone(tmp_path: Path) -> None:
    mesh, new, told = onto(tmp_path, character(), rig=False)
    assert np.abs(mesh.vertices - BODY.vertices).max() < NEAR
    assert "skins" not in new.tree and (told.bones, told.shapes) == (0, 0)
    assert "JOINTS_0" not in new.tree["meshes"][0]["primitives"][0]["attributes"]
    assert len(new.tree["images"]) == 2


def test_a_file_of_other_faces_or_without_sense_is_refused(tmp_path: Path) -> None:
    target = read_mesh_of(tmp_path, character())
    other = Mesh(target.vertices, target.faces[::-1])
    with pytest.raises(BadLook, match="in another order"):
        carry_scene(identity(other, other), tmp_path / "some.glb")


def test_the_command(tmp_path: Path) -> None:
    (tmp_path / "c.glb").write_bytes(character())
    target = read_mesh(tmp_path / "c.glb")
    write_mesh(target, tmp_path / "a.ply")
    source = read_mesh(tmp_path / "a.ply")
    identity(source, target).save(tmp_path / "map.npz")
    call = ["transfer", "map.npz", "--source", "a.ply", "--target", "c.glb", "-o", "new.glb"]
    call = [str(tmp_path / word) if "." in word else word for word in call]
    result = CliRunner().invoke(main, [*call, "--rig", "--json"])
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert (said["carried"], said["parts"], said["materials"]) == ("scene", ["Body"], ["fur", "eyes"])
    assert (said["bones"], said["shapes"]) == (3, 2) and "not carried" not in result.stderr
    result = CliRunner().invoke(main, [*call, "--json"])
    assert "bones and their weights, shapes to morph to; --rig" in result.stderr
    assert "bones" not in json.loads(result.stdout)
    for wrong in (["--values", call[5]], ["--most", "2"]):
        assert CliRunner().invoke(main, [*call, *wrong, *(["--rig"] if wrong[0] == "--values" else [])]).exit_code == 2
    assert CliRunner().invoke(main, [*call[:-1], str(tmp_path / "o.ply"), "--rig"]).exit_code == 2


def test_the_character_of_the_demo_is_a_whole_one(tmp_path: Path) -> None:
    """What `gmds demo --files` writes: four bones in a chain, their weights, a texture and a shape to morph to."""
    pytest.importorskip("PIL")
    from gmds.characters.scene import read_scene
    from gmds.demo.files import write_files

    write_files(tmp_path, 300)
    path = tmp_path / "character.glb"
    wolf = read_mesh(path)
    scene = read_scene(path, wolf, rig=True)
    assert np.allclose(scene.weights, np.load(tmp_path / "bones.npy"), atol=1e-6) and len(scene.bones) == 4
    assert [len(each) for each in scene.shapes.values()] == [1] and list(scene.coordinates) == ["TEXCOORD_0"]
    assert [each["name"] for each in scene.gltf.tree["materials"]] == ["fur"] and scene.gltf.tree["images"]
    assert not_kept(tmp_path / "wolf.glb") == ["the texture"] and not_kept(tmp_path / "wolf.glb", materials=True) == []
    content, told = carry_scene(identity(wolf, wolf), path)
    again = open_gltf(content, tmp_path / "again.glb")
    assert (told.bones, told.shapes, told.materials) == (4, 1, ["fur"])
    worlds = [world_matrices(gltf) for gltf in (scene.gltf, again)]
    assert all(np.allclose(worlds[0][bone], worlds[1][bone], atol=1e-5) for bone in scene.bones)
