"""What is told not to be carried: only what is there."""

from __future__ import annotations

from pathlib import Path

import pytest
from file_cases import OBJ, OFF, glb, setting
from other_formats import RIG, gltf, halves, skinned, with_bytes

from gmds.appearance.keeping import not_kept

QUAD = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"


@pytest.mark.parametrize(
    ("content", "lost"),
    [
        (OFF.encode(), []),
        (OBJ.encode(), []),
        (glb(), []),
        (gltf(), []),
        (b"usemtl skin\no dog\n" + OBJ.encode(), ["materials", "names of objects"]),
        (QUAD.encode(), ["polygons of more than three corners (written as triangles)"]),
        (glb(halves), ["names of parts", "names of materials"]),
        (with_bytes(glb(skinned), RIG), ["bones and their weights", "shapes to morph to"]),
        (glb(setting("animations", value=[{}])), ["animations"]),
    ],
)
def test_what_is_lost(tmp_path: Path, content: bytes, lost: list[str]) -> None:
    (tmp_path / "a").write_bytes(content)
    assert not_kept(tmp_path / "a") == lost
    animated = [word for word in lost if word == "animations"]
    assert kind_of(content) != "scene" or not_kept(tmp_path / "a", materials=True, rig=True) == animated


def test_a_texture_is_all_that_one_material_is(tmp_path: Path) -> None:
    (tmp_path / "one.obj").write_text("usemtl skin\n" + OBJ)
    (tmp_path / "two.obj").write_text("usemtl skin\n" + OBJ + "usemtl eyes\nf 1 2 3\n")
    assert not_kept(tmp_path / "one.obj", texture=True) == []
    assert not_kept(tmp_path / "two.obj", texture=True) == ["materials"]


def kind_of(content: bytes) -> str:
    return "scene" if content[:4] == b"glTF" or content[:1] == b"{" else "other"


def test_a_file_that_is_two(tmp_path: Path) -> None:
    assert not_kept(tmp_path / "stem of a TOSCA shape") == []
