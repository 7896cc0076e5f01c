"""A character with materials of its own gets bones of another one and keeps its parts, images and coordinates."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from rigged import BODY, SHAPES, character

from geodesics import Mesh, SurfacePoints, read_mesh, write_mesh
from geodesics.io.gltf_accessor import read_accessor
from geodesics.io.gltf_container import Gltf, open_gltf
from gmds.appearance import Look, write_look
from gmds.characters import carry_scene, has_look
from gmds.characters.scene import read_scene
from gmds.cli import main
from gmds.correspondence import Correspondence

Image = pytest.importorskip("PIL.Image")


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """own.glb, a body with a texture of one piece, character.glb, a rigged one of two materials, and the map."""
    (tmp_path / "character.glb").write_bytes(character())
    seen = np.random.default_rng(0).random((BODY.n_faces, 3, 2)).round(3)
    own = Mesh(BODY.vertices * 2 + 1, BODY.faces)
    write_look(tmp_path / "own.glb", own, Look(uv=seen, image=Image.new("RGB", (6, 6), (9, 8, 7))))
    source, target = read_mesh(tmp_path / "own.glb"), read_mesh(tmp_path / "character.glb")
    there = SurfacePoints.closest(target, (source.vertices - 1) / 2)
    Correspondence.from_points(source, there).save(tmp_path / "map.npz")
    return tmp_path


def image_of(gltf: Gltf) -> bytes:
    (image,) = gltf.tree["images"]
    return bytes(gltf.bytes_of_view(image["bufferView"], "an image")[0])


def called(files: Path, *more: str) -> Any:
    words = ["transfer", "map.npz", "--source", "own.glb", "--target", "character.glb", "-o", "new.glb", "--rig"]
    return CliRunner().invoke(main, [*(str(files / word) if "." in word else word for word in words), "--json", *more])


def test_a_body_keeps_its_texture_and_gets_bones_and_shapes(files: Path) -> None:
    result = called(files)
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert (said["bones"], said["shapes"], said["faces_on_seams"]) == (3, 2, 0)
    assert "keeps its own materials; --carried-look" in result.stderr
    assert "not carried" not in result.stderr, "nothing of the source is lost"
    own, new = (open_gltf((files / name).read_bytes(), files / name) for name in ("own.glb", "new.glb"))
    assert image_of(new) == image_of(own) and new.tree["materials"] == own.tree["materials"]
    surfaces = [read_mesh(files / name) for name in ("own.glb", "new.glb")]
    before, after = (
        read_scene(files / name, mesh, rig=True) for name, mesh in zip(("own.glb", "new.glb"), surfaces, strict=True)
    )
    order = [np.lexsort(one.coordinates["TEXCOORD_0"].reshape(len(one.surface.faces), 6).T) for one in (before, after)]
    corners = [one.surface.vertices[one.surface.faces[rows]] for one, rows in zip((before, after), order, strict=True)]
    assert np.allclose(*corners, atol=1e-5), "each corner has the coordinates that it had"
    assert len(after.bones) == 3 and np.allclose(after.weights.sum(axis=1), 1, atol=1e-6)
    assert new.tree["meshes"][0]["extras"]["targetNames"] == list(SHAPES)
    bones = {node["name"] for node in new.tree["nodes"]}
    assert {"hips", "Armature"} <= bones


def test_the_look_of_the_target_is_taken_when_asked_for(files: Path) -> None:
    result = called(files, "--carried-look")
    assert json.loads(result.stdout)["materials"] == ["fur", "eyes"] and "not carried" in result.stderr
    assert json.loads(called(files, "--own-look").stdout)["materials"] != ["fur", "eyes"]


def test_what_has_no_look_gets_that_of_the_target_and_words_that_do_not_fit_are_refused(files: Path) -> None:
    write_mesh(read_mesh(files / "own.glb"), files / "plain.glb")
    assert has_look(files / "own.glb") and not has_look(files / "plain.glb")
    plain = ["--source", str(files / "plain.glb")]
    result = called(files, *plain)
    assert json.loads(result.stdout)["materials"] == ["fur", "eyes"], result.output
    assert called(files, *plain, "--own-look").exit_code == 2
    words = ["transfer", str(files / "map.npz"), "--source", str(files / "own.glb"), "--own-look"]
    words += ["--target", str(files / "character.glb"), "-o", str(files / "new.glb")]
    assert CliRunner().invoke(main, words).exit_code == 2, "only with --rig"


def test_another_character_of_two_materials_keeps_both(files: Path) -> None:
    """From a character to itself, its own look or the carried one are the same."""
    mesh = read_mesh(files / "character.glb")
    answer = Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)))
    path = files / "character.glb"
    written = [open_gltf(carry_scene(answer, path, own=own)[0], path) for own in (None, path)]
    for name in ("materials", "images", "textures"):
        assert written[0].tree.get(name) == written[1].tree.get(name)
    first, second = ([each["primitives"] for each in one.tree["meshes"]] for one in written)
    assert [[one["material"] for one in part] for part in first] == [
        [one["material"] for one in part] for part in second
    ]
    uv = [read_accessor(g, g.tree["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"], "VEC2") for g in written]
    assert np.allclose(*uv, atol=1e-6)
