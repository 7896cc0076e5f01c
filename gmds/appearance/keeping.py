"""What is in a file of a mesh beside the surface and its look, which is not carried along a map, in words.

| code | says |
|---|---|
| W228 | what a file has beside its surface (bones, animations, names, ...) is not carried along the map |
"""

from __future__ import annotations

from pathlib import Path

from geodesics.io.gltf_container import Gltf, open_gltf
from geodesics.io.obj import statements
from geodesics.io.opening import read_bytes
from geodesics.io.reading import contents_of
from geodesics.io.sniffing import sniff
from geodesics.notes import Note
from gmds.appearance.names import NONE

OBJ_WORDS = {"usemtl": "materials", "o": "names of objects", "g": "groups", "s": "smoothing groups", "vn": "normals"}


def not_kept(
    path: Path,
    *,
    materials: bool = False,
    names: bool = False,
    rig: bool = False,
    polygons: bool = False,
    texture: bool = False,
) -> list[str]:
    """What of a file, of these kinds, is lost when its surface is written anew.

    Parameters
    ----------
    path : Path
        A file that was read as a mesh.
    materials, rig : bool
        What of a scene is carried: parts and materials, bones and shapes to morph to.
    names : bool
        Whether names of objects, groups, parts and materials are carried.
    polygons : bool
        Whether polygons are kept, or are of no concern.
    texture : bool
        Whether texture coordinates and one image are carried: of a file with one material at most all it looks like.

    Returns
    -------
    list of str
        Kinds of things, such as "bones".
    """
    data = read_bytes(path) if path.is_file() else b""
    kind = sniff(data, path) if data else ""
    if kind in ("glb", "gltf"):
        return _of_scene(open_gltf(data, path), materials or names, rig)
    rows = [row.words for row in statements(data, path)] if kind == "obj" else []
    found = {words[0] for words in rows}
    if texture and len({tuple(words) for words in rows if words[0] == "usemtl"}) == 1:
        found.discard("usemtl")
    kinds = [told for word, told in OBJ_WORDS.items() if word in found and not (names and word in NONE)]
    contents = contents_of(path) if data and not polygons else None
    larger = contents is not None and contents.polygons is not None and bool((contents.polygons[0] > 3).any())
    return [*kinds, *(["polygons of more than three corners (written as triangles)"] if larger else [])]


def lost_note(path: Path, lost: list[str], hint: str = "") -> Note:
    """W228."""
    return Note("W228", "info", f"not carried from {path}: {', '.join(lost)}{hint}", (), len(lost))


def _of_scene(gltf: Gltf, materials: bool, rig: bool) -> list[str]:
    tree = gltf.tree
    primitives = [each for mesh in tree.get("meshes", []) for each in mesh["primitives"]]
    there = {
        "names of parts": not materials and len(primitives) > 1,
        "names of materials": not materials and any(each.get("name") for each in tree.get("materials", [])),
        "the texture": not materials and bool(tree.get("images")),
        "bones and their weights": not rig and bool(tree.get("skins")),
        "shapes to morph to": not rig and any(each.get("targets") for each in primitives),
        "animations": bool(tree.get("animations")),
    }
    return [told for told, is_there in there.items() if is_there]
