"""What is in a file of a mesh beside the surface and its look, which is not carried along a map, in words."""

from __future__ import annotations

from pathlib import Path

from geodesics.io.gltf_container import Gltf, open_gltf
from geodesics.io.obj import statements
from geodesics.io.opening import read_bytes
from geodesics.io.sniffing import sniff

OBJ_WORDS = {"usemtl": "materials", "o": "names of objects", "g": "groups", "s": "smoothing groups", "vn": "normals"}


def not_kept(path: Path, *, materials: bool = False, rig: bool = False) -> list[str]:
    """What of a glTF or OBJ file, of these kinds, is lost when its surface is written anew; nothing for others.

    Parameters
    ----------
    path : Path
        A file that was read as a mesh.
    materials, rig : bool
        What of a scene is carried: parts and materials, bones and shapes to morph to.

    Returns
    -------
    list of str
        Kinds of things, such as "bones".
    """
    data = read_bytes(path) if path.is_file() else b""
    kind = sniff(data, path) if data else ""
    if kind in ("glb", "gltf"):
        return _of_scene(open_gltf(data, path), materials, rig)
    if kind != "obj":
        return []
    found = {row.words[0]: len(row.words) for row in statements(data, path)}
    kinds = [told for word, told in OBJ_WORDS.items() if word in found]
    larger = any(len(row.words) > 4 for row in statements(data, path) if row.words[0] == "f")
    return [*kinds, *(["polygons of more than three corners (written as triangles)"] if larger else [])]


def _of_scene(gltf: Gltf, materials: bool, rig: bool) -> list[str]:
    tree = gltf.tree
    primitives = [each for mesh in tree.get("meshes", []) for each in mesh["primitives"]]
    there = {
        "names of parts": not materials and len(primitives) > 1,
        "names of materials": not materials and any(each.get("name") for each in tree.get("materials", [])),
        "bones and their weights": not rig and bool(tree.get("skins")),
        "shapes to morph to": not rig and any(each.get("targets") for each in primitives),
        "animations": bool(tree.get("animations")),
    }
    return [told for told, is_there in there.items() if is_there]
