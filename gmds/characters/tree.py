"""The description of a scene with another surface in it: nodes, skin and images as they were, and new meshes."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from geodesics.arrays import Floats
from geodesics.io.gltf_container import Gltf
from geodesics.io.gltf_nodes import Placed, local_matrix
from gmds.characters.packing import Packer

NOT_WRITTEN = (  # extensions of numbers that are written anew, plainly
    "KHR_mesh_quantization",
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
)
VARIANTS = "KHR_materials_variants"
SAME = 1e-9  # relative: a node whose transform changes by less keeps it as it was written
UNSHEARED = 1e-6  # relative: what translation, rotation and scale may miss of a transform


def start_of(gltf: Gltf, packer: Packer, look: Gltf | None = None) -> dict[str, Any]:
    """A copy of the description without meshes, skins and numbers; materials are those of `look`, images are packed."""
    tree = copy.deepcopy(gltf.tree)
    if look is not None:
        _take_materials(tree, look.tree)
    for image in tree.get("images", []):
        if "bufferView" in image:
            image["bufferView"] = packer.view((look or gltf).bytes_of_view(image["bufferView"], "an image")[0])
    for name in ("animations", "accessors", "bufferViews", "buffers", "skins", "meshes"):
        tree.pop(name, None)
    for name in ("extensionsUsed", "extensionsRequired"):
        left = [one for one in tree.pop(name, []) if one not in NOT_WRITTEN]
        tree |= {name: left} if left else {}
    for node in tree.get("nodes", []):
        for name in ("mesh", "skin", "weights"):
            node.pop(name, None)
    tree.setdefault("nodes", [])
    if not tree.get("scenes"):
        below = {child for node in tree["nodes"] for child in node.get("children", [])}
        tree["scenes"], tree["scene"] = [{"nodes": [i for i in range(len(tree["nodes"])) if i not in below]}], 0
    return tree


def _take_materials(tree: dict[str, Any], look: dict[str, Any]) -> None:
    """Materials, with their textures and the extensions that they need, of another description."""
    for name in ("materials", "textures", "images", "samplers", "extensionsRequired"):
        tree.pop(name, None)
        tree |= {name: copy.deepcopy(look[name])} if name in look else {}
    used = list(dict.fromkeys([*tree.pop("extensionsUsed", []), *look.get("extensionsUsed", [])]))
    tree |= {"extensionsUsed": used} if used else {}
    about = tree.pop("extensions", {})
    about.pop(VARIANTS, None)
    if VARIANTS in look.get("extensions", {}):
        about[VARIANTS] = copy.deepcopy(look["extensions"][VARIANTS])
    tree |= {"extensions": about} if about else {}


def node_for(tree: dict[str, Any], place: Placed, bones: list[int], worlds: dict[int, Floats]) -> dict[str, Any]:
    """A node in which numbers are those of the scene: that of `place`, at the root if need be, or a new one."""
    nodes, roots = tree["nodes"], tree["scenes"][tree.get("scene", 0)].setdefault("nodes", [])
    number = place.node
    if number is not None and number not in bones and np.abs(worlds[number] - np.eye(4)).max() <= SAME:
        there: dict[str, Any] = nodes[number]
        return there
    if number is None or number in bones or nodes[number].get("children"):
        nodes.append({"name": place.name} if place.name else {})
        number = len(nodes) - 1
    for node in nodes:
        if number in node.get("children", []):
            node["children"] = [child for child in node["children"] if child != number]
            if not node["children"]:
                node.pop("children")
    if number not in roots:
        roots.append(number)
    for name in ("matrix", "translation", "rotation", "scale"):
        nodes[number].pop(name, None)
    found: dict[str, Any] = nodes[number]
    return found


def move_nodes(tree: dict[str, Any], gltf: Gltf, worlds: dict[int, Floats]) -> None:
    """Give nodes the transforms to the scene that `worlds` says, each within the one above it."""
    above = {child: node for node in worlds for child in gltf.item("nodes", node).get("children", [])}
    for number, world in worlds.items():
        parent = worlds.get(above[number]) if number in above else None
        local = world if parent is None else np.linalg.solve(parent, world)
        node = tree["nodes"][number]
        if np.abs(local - local_matrix(node)).max() <= SAME * max(1.0, np.abs(local).max()):
            continue
        for name in ("matrix", "translation", "rotation", "scale"):
            node.pop(name, None)
        node |= described(np.asarray(local, dtype=np.float64))


def described(local: Floats) -> dict[str, list[float]]:
    """A transform (4, 4) as translation, rotation and scale; as a matrix, where it shears."""
    from scipy.spatial.transform import Rotation

    scale = np.linalg.norm(local[:3, :3], axis=0)
    if np.linalg.det(local[:3, :3]) < 0:
        scale[0] = -scale[0]
    if (scale != 0).all():
        turn = local[:3, :3] / scale
        rotation = Rotation.from_matrix(turn)
        if np.abs(rotation.as_matrix() - turn).max() <= UNSHEARED:
            return {
                "translation": local[:3, 3].tolist(),
                "rotation": rotation.as_quat().tolist(),
                "scale": scale.tolist(),
            }
    return {"matrix": local.T.ravel().tolist()}
