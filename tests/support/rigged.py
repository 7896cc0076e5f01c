"""A rigged character of code: an animal of two materials with a skeleton of three bones and shapes to morph to."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from geodesics import Mesh
from gmds.characters.packing import Packer
from gmds.shapes import quadruped

BODY = quadruped(n_vertices=400)
JOINTS = np.array(
    [(-0.5, 0.0, 0.0), (0.0, 0.0, 0.0), (0.6, 0.0, 0.0)]
)  # in halves of the body's extent, from its middle
SHAPES = ("smile", "frown")


def joints_of(mesh: Mesh) -> np.ndarray:
    """Places (3, 3) of the joints, along the longest axis."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    order = np.argsort(low - high)
    return np.asarray((low + high) / 2 + JOINTS[:, np.argsort(order)] * (high - low) / 2)


def weights_of(mesh: Mesh) -> np.ndarray:
    """Weights (n, 3) of the bones, that blend around the joints."""
    joints = joints_of(mesh)
    axis = int(np.argmax(np.ptp(mesh.vertices, axis=0)))
    x, reach = mesh.vertices[:, axis], 0.2 * np.ptp(mesh.vertices[:, axis])
    second, third = (np.clip((x - joints[i, axis]) / reach + 0.5, 0, 1) for i in (1, 2))
    return np.stack([1 - second, second * (1 - third), second * third], axis=1)


def displacements(mesh: Mesh) -> np.ndarray:
    """Two shapes (2, n, 3): up, and along the surface's place."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    u = (mesh.vertices - low) / (high - low)
    size = 0.1 * np.linalg.norm(high - low)
    return np.asarray(size * np.stack([u * (0, 0, 1), (1 - u[:, :1]) * np.array([[1.0, 0.5, 0.0]])]))


def image_bytes(colour: tuple[int, int, int]) -> bytes:
    from PIL import Image

    out = io.BytesIO()
    Image.new("RGB", (4, 4), colour).save(out, format="PNG")
    return out.getvalue()


def character(mesh: Mesh = BODY, change: Any = None, pose: bool = False) -> bytes:
    """A GLB file; `pose`: the last bone is turned, away from the pose in which it was bound."""
    packer = Packer()
    weights, joints = weights_of(mesh), joints_of(mesh)
    position = packer.attribute(mesh.vertices.astype(np.float32), bounds=True)
    padded = np.zeros((mesh.n_vertices, 4), np.float32)
    padded[:, :3] = weights
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    uv = ((mesh.vertices - low) / (high - low))[:, :2]
    attributes = {
        "POSITION": position,
        "NORMAL": packer.attribute(np.tile(np.float32([[0, 0, 1]]), (mesh.n_vertices, 1))),
        "TEXCOORD_0": packer.attribute(uv.astype(np.float32)),
        "JOINTS_0": packer.attribute(np.tile(np.uint8([[0, 1, 2, 0]]), (mesh.n_vertices, 1))),
        "WEIGHTS_0": packer.attribute(padded),
    }
    targets = [{"POSITION": packer.attribute(one.astype(np.float32), bounds=True)} for one in displacements(mesh)]
    half = mesh.vertices[mesh.faces].mean(axis=1)[:, 2] > np.median(mesh.vertices[:, 2])
    bind = np.tile(np.eye(4), (3, 1, 1))
    bind[:, 3, :3] = -joints
    turn = {"rotation": [0.0, 0.0, float(np.sin(0.3)), float(np.cos(0.3))]} if pose else {}
    tree: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"name": "Armature", "children": [1, 4]},
            {"name": "hips", "translation": joints[0].tolist(), "children": [2]},
            {"name": "chest", "translation": (joints[1] - joints[0]).tolist(), "children": [3]},
            {"name": "head", "translation": (joints[2] - joints[1]).tolist(), "children": [5], **turn},
            {"name": "Body", "mesh": 0, "skin": 0},
            {"name": "hat", "translation": [0.0, 0.0, 0.1]},
        ],
        "skins": [{
            "name": "rig", "joints": [1, 2, 3], "skeleton": 1,
            "inverseBindMatrices": packer.table(bind.reshape(3, 16).astype(np.float32)),
        }],
        "materials": [
            {"name": "fur", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
            {"name": "eyes", "pbrMetallicRoughness": {"baseColorTexture": {"index": 1}}},
        ],
        "textures": [{"source": 0}, {"source": 1}],
        "images": [
            {"mimeType": "image/png", "bufferView": packer.view(image_bytes((200, 90, 10)))},
            {"mimeType": "image/png", "bufferView": packer.view(image_bytes((10, 90, 200)))},
        ],
        "meshes": [{
            "name": "BodyMesh",
            "extras": {"targetNames": list(SHAPES)},
            "weights": [0.0, 0.0],
            "primitives": [
                {"attributes": attributes, "targets": targets, "material": i,
                 "indices": packer.indices(mesh.faces[half == bool(i)])}
                for i in range(2)
            ],
        }],
    }  # fmt: skip
    if change:
        change(tree)
    return packer.glb(tree)
