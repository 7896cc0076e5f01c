"""GLB: binary glTF with exactly one triangle mesh in it."""

from __future__ import annotations

import json
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from geodesics.errors import BadContainer, ExternalReference, TruncatedFile
from geodesics.io.text import Contents

_ITEM_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}  # by componentType (glTF 2.0, sec. 3.6.2.2)
_ITEMS = {"SCALAR": 1, "VEC3": 3}  # numbers in an element, by type of accessor


def read_glb(data: bytes, path: Path) -> Contents:
    """The one mesh of a GLB file, placed by its node; `BadContainer` when lengths disagree or meshes are several."""
    try:
        _check(data, path)
    except (KeyError, IndexError, TypeError, AttributeError, RecursionError) as error:
        raise BadContainer(f"{path}: the glTF description is malformed ({error!r})") from error
    from trimesh import load

    try:
        scene: Any = load(BytesIO(data), file_type="glb", process=False, skip_materials=True)
        nodes = list(scene.graph.nodes_geometry)
        transform, name = scene.graph[nodes[0]]
        shape = scene.geometry[name]
        vertices = np.array(shape.vertices) @ transform[:3, :3].T + transform[:3, 3]
        faces = np.array(shape.faces)
    except Exception as error:  # whatever a third-party reader throws on a bad file
        raise BadContainer(f"{path}: the glTF content cannot be read ({error!r})") from error
    if len(nodes) != 1:
        raise BadContainer(f"{path}: {len(nodes)} meshes are placed in the scene; export exactly one")
    return Contents(vertices, faces)


def _check(data: bytes, path: Path) -> None:
    """Every declared length against the bytes that are there, before anything is allocated."""
    if len(data) < 20 or int.from_bytes(data[8:12], "little") != len(data):
        raise TruncatedFile(f"{path}: the GLB header declares another length than the {len(data)} bytes found")
    if int.from_bytes(data[4:8], "little") != 2:
        raise BadContainer(f"{path}: only version 2 of glTF is supported")
    chunks, at = [], 12
    while at < len(data):
        size = int.from_bytes(data[at : at + 4], "little")
        if at + 8 + size > len(data):
            raise TruncatedFile(f"{path}, byte {at}: a chunk of {size} bytes passes the end of the file")
        chunks.append(data[at + 8 : at + 8 + size])
        at += 8 + size
    try:
        tree = json.loads(chunks[0])
    except (ValueError, RecursionError) as error:
        raise BadContainer(f"{path}: the JSON part is malformed ({error})") from error
    _check_tree(tree, len(chunks[1]) if len(chunks) > 1 else 0, path)


def _check_tree(tree: dict[str, Any], n_bytes: int, path: Path) -> None:
    if any("uri" in item for item in [*tree.get("buffers", []), *tree.get("images", [])]):
        raise ExternalReference(f"{path}: data in other files is not opened; export one self-contained GLB")
    meshes = tree.get("meshes", [])
    primitives = [primitive for mesh in meshes for primitive in mesh["primitives"]]
    if len(primitives) != 1:
        raise BadContainer(f"{path}: {len(primitives)} mesh parts in the file; export exactly one")
    if primitives[0].get("mode", 4) != 4 or "indices" not in primitives[0]:
        raise BadContainer(f"{path}: only indexed triangles are supported")
    for key in (primitives[0]["indices"], primitives[0]["attributes"]["POSITION"]):
        accessor = tree["accessors"][key]
        view = tree["bufferViews"][accessor["bufferView"]]
        needed = accessor["count"] * _ITEM_BYTES[accessor["componentType"]] * _ITEMS[accessor["type"]]
        start, length = view.get("byteOffset", 0), view["byteLength"]
        if min(start, length, accessor["count"]) < 0 or "sparse" in accessor:
            raise BadContainer(f"{path}: accessor {key} is sparse or has a negative length")
        if start + length > n_bytes or accessor.get("byteOffset", 0) + needed > length:
            raise BadContainer(f"{path}: accessor {key} needs {needed} bytes, more than its part of the file holds")
