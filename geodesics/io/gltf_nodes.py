"""Where the meshes of a glTF scene stand: nodes, their transforms, morph weights and skins."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from geodesics.arrays import Floats
from geodesics.errors import BadContainer
from geodesics.io.gltf_accessor import read_accessor
from geodesics.io.gltf_container import Gltf


@dataclass(frozen=True, eq=False)
class Placed:
    """A mesh as a node places it; `joints` (j, 4, 4) are those of its skin in the pose of the file.

    `node` is None where no scene places it.
    """

    name: str
    mesh: dict[str, Any]
    matrix: Floats
    weights: list[float]
    skin: int | None
    joints: Floats | None
    node: int | None = None

    @property
    def mirrored(self) -> bool:
        """Whether the node turns the surface inside out, so that faces are to be turned back (glTF 2.0, sec. 3.7.4)."""
        return self.joints is None and bool(np.linalg.det(self.matrix[:3, :3]) < 0)


def placed_meshes(gltf: Gltf) -> Iterator[Placed]:
    """Every mesh of the scene; where no scene places any, every mesh that there is, as it is."""
    worlds = world_matrices(gltf)
    found = False
    for index, matrix in worlds.items():
        node = gltf.item("nodes", index)
        if "mesh" not in node:
            continue
        if "EXT_mesh_gpu_instancing" in node.get("extensions", {}):
            raise BadContainer(f"{gltf.path}: EXT_mesh_gpu_instancing is not supported; export the copies as nodes")
        found = True
        yield _placed(gltf, index, matrix, worlds)
    if not found:
        for mesh in gltf.tree.get("meshes", []):
            yield Placed(str(mesh.get("name", "")), mesh, np.eye(4), mesh.get("weights", []), None, None)


def _placed(gltf: Gltf, index: int, matrix: Floats, worlds: dict[int, Floats]) -> Placed:
    node = gltf.item("nodes", index)
    mesh = gltf.item("meshes", node["mesh"])
    name = str(node.get("name", "") or mesh.get("name", ""))
    weights = node.get("weights", mesh.get("weights", []))
    if "skin" not in node:
        return Placed(name, mesh, matrix, weights, None, None, index)
    skin = gltf.item("skins", node["skin"])
    joints = np.stack([worlds.get(joint, np.eye(4)) for joint in skin["joints"]])
    if "inverseBindMatrices" in skin:
        bind = read_accessor(gltf, skin["inverseBindMatrices"], "MAT4").astype(np.float64).reshape(-1, 4, 4)
        if len(bind) < len(joints):
            raise BadContainer(f"{gltf.path}: skin {node['skin']} has {len(joints)} joints and {len(bind)} matrices")
        joints = joints @ bind[: len(joints)].transpose(0, 2, 1)  # they are stored by columns
    return Placed(name, mesh, matrix, weights, node["skin"], joints, index)


def world_matrices(gltf: Gltf) -> dict[int, Floats]:
    """The transform (4, 4) to the scene of every node in it, each once, in the order in which they are met."""
    nodes = gltf.tree.get("nodes", [])
    scenes = gltf.tree.get("scenes", [])
    if scenes:
        roots = gltf.item("scenes", gltf.tree.get("scene", 0)).get("nodes", [])
    else:
        below = {child for node in nodes for child in node.get("children", [])}
        roots = [index for index in range(len(nodes)) if index not in below]
    found: dict[int, Floats] = {}
    waiting = [(index, np.eye(4)) for index in reversed(roots)]
    while waiting:
        index, above = waiting.pop()
        if index in found:
            continue
        node = gltf.item("nodes", index)
        found[index] = above @ local_matrix(node)
        waiting += [(child, found[index]) for child in reversed(node.get("children", []))]
    return found


def local_matrix(node: dict[str, Any]) -> Floats:
    """The transform (4, 4) of a node within its parent: a matrix, or translation x rotation x scale."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", [0, 0, 0, 1]), dtype=np.float64).reshape(4)
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.array(node.get("scale", [1, 1, 1]), dtype=np.float64).reshape(3)
    matrix[:3, 3] = np.array(node.get("translation", [0, 0, 0]), dtype=np.float64).reshape(3)
    return matrix


def posed(gltf: Gltf, place: Placed, primitive: dict[str, Any]) -> Floats:
    """Positions (n, 3) of a primitive in the scene: morphed, then moved by its skin, or else by its node."""
    positions = read_accessor(gltf, primitive["attributes"]["POSITION"], "VEC3").astype(np.float64)
    for weight, target in zip(place.weights, primitive.get("targets", []), strict=False):
        if weight and "POSITION" in target:
            positions = positions + float(weight) * same_length(gltf, target["POSITION"], "VEC3", positions)
    motion = motions(gltf, place, primitive, positions)
    return np.asarray(np.einsum("nij,nj->ni", motion[:, :, :3], positions) + motion[:, :, 3], dtype=np.float64)


def motions(gltf: Gltf, place: Placed, primitive: dict[str, Any], positions: Floats) -> Floats:
    """How its skin, or else its node, moves every vertex of a primitive, (n, 3, 4)."""
    by_node = np.broadcast_to(place.matrix[:3], (len(positions), 3, 4))
    if place.joints is None or "JOINTS_0" not in primitive["attributes"]:
        return by_node
    joint, share = skin_of(gltf, place, primitive, positions)
    blend = np.einsum("nk,nkij->nij", share, place.joints[joint, :3])
    return np.where(share.sum(axis=1)[:, None, None] > 0, blend, by_node)


def skin_of(gltf: Gltf, place: Placed, primitive: dict[str, Any], positions: Floats) -> tuple[np.ndarray, Floats]:
    """Joints (n, 4 s) of the skin that hold every vertex, and weights of sum 1, or 0 where no joint holds it."""
    attributes, joints, weights = primitive["attributes"], [], []
    for number in range(len(attributes)):
        if f"JOINTS_{number}" not in attributes:
            break
        joints.append(same_length(gltf, attributes[f"JOINTS_{number}"], "VEC4", positions).astype(np.int64))
        weights.append(same_length(gltf, attributes[f"WEIGHTS_{number}"], "VEC4", positions).astype(np.float64))
    weight = np.concatenate(weights, axis=1)
    weight = np.where(np.isfinite(weight), np.maximum(weight, 0), 0)
    total = weight.sum(axis=1, keepdims=True)
    joint = np.concatenate(joints, axis=1)
    if place.joints is None or joint.max(initial=0) >= len(place.joints):
        raise BadContainer(f"{gltf.path}: a vertex hangs on joint {joint.max(initial=0)}, which its skin does not have")
    return joint, np.divide(weight, total, out=np.zeros_like(weight), where=total > 0)


def same_length(gltf: Gltf, index: Any, kind: str, positions: Floats) -> np.ndarray:
    """The table of an accessor that must have a row for every position."""
    table = read_accessor(gltf, index, kind)
    if len(table) != len(positions):
        raise BadContainer(f"{gltf.path}: accessor {index} has {len(table)} rows for {len(positions)} vertices")
    return table
