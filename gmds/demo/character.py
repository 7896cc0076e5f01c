"""character.glb: the wolf with a skeleton, weights, a texture and a shape to morph to."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Floats
from geodesics.io import atomic_write
from gmds.characters.packing import Packer

NAMES = ("hips", "spine", "chest", "head")  # of the bones of bones.npy, from the tail to the nose
GRID = 1024  # parts of a unit in which joints stand, so that the pose at rest is exactly the mesh
OPEN = 0.15  # of the height, by which the shape to morph to lifts the head; set by hand


def write_character(path: Path, mesh: Mesh, weights: Floats, image: Any) -> None:
    """A GLB file of one part, whose triangles are those of the mesh.

    Parameters
    ----------
    path : path
        The file.
    mesh : Mesh
        The body, of n vertices.
    weights : array of shape (n, 4)
        How far each bone holds each vertex.
    image : PIL image
        The texture, laid on from the side.
    """
    packer = Packer()
    low, span = mesh.vertices.min(axis=0), np.ptp(mesh.vertices, axis=0)
    joints = (weights.T @ mesh.vertices) / weights.sum(axis=0)[:, None]  # in the middle of what a bone holds
    joints[1:] = (joints[1:] + joints[:-1]) / 2  # where it begins
    joints = np.rint(joints * GRID) / GRID
    lifted = weights[:, 3:] * [0, 0, OPEN * span[2]]
    attributes = {
        "POSITION": packer.attribute(mesh.vertices.astype(np.float32), bounds=True),
        "TEXCOORD_0": packer.attribute(((mesh.vertices - low) / span)[:, [0, 2]].astype(np.float32)),
        "JOINTS_0": packer.attribute(np.tile(np.arange(4, dtype=np.uint8), (mesh.n_vertices, 1))),
        "WEIGHTS_0": packer.attribute(weights.astype(np.float32)),
    }
    primitive = {
        "attributes": attributes,
        "indices": packer.indices(mesh.faces),
        "targets": [{"POSITION": packer.attribute(lifted.astype(np.float32), bounds=True)}],
        "material": 0,
    }
    content = packer.glb({**_skeleton(packer, joints), **_looks(packer, image), "meshes": [_body(primitive)]})
    with atomic_write(path) as stream:
        stream.write(content)


def _body(primitive: dict[str, Any]) -> dict[str, Any]:
    return {"name": "Wolf", "primitives": [primitive], "weights": [0.0], "extras": {"targetNames": ["look up"]}}


def _skeleton(packer: Packer, joints: Floats) -> dict[str, Any]:
    """Bones one behind the other, and the body that hangs on them."""
    bind = np.tile(np.eye(4), (len(joints), 1, 1))
    bind[:, 3, :3] = -joints  # by columns, as glTF has its matrices
    places = np.diff(joints, axis=0, prepend=np.zeros((1, 3)))
    bones: list[dict[str, Any]] = [
        {"name": name, "translation": place} for name, place in zip(NAMES, places.tolist(), strict=True)
    ]
    for i, bone in enumerate(bones[:-1]):
        bone["children"] = [i + 1]
    bodies = [{"name": "Body", "mesh": 0, "skin": 0}, {"name": "Armature", "children": [len(bones), 0]}]
    inverse = packer.table(bind.reshape(len(joints), 16).astype(np.float32))
    return {
        "asset": {"version": "2.0", "generator": "gmds demo"},
        "scene": 0,
        "scenes": [{"nodes": [len(bones) + 1]}],
        "nodes": bones + bodies,
        "skins": [{"name": "rig", "joints": list(range(len(bones))), "inverseBindMatrices": inverse}],
    }


def _looks(packer: Packer, image: Any) -> dict[str, Any]:
    """One material with the image on it."""
    stream = io.BytesIO()
    image.save(stream, format="PNG")
    return {
        "materials": [{"name": "fur", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"mimeType": "image/png", "bufferView": packer.view(stream.getvalue())}],
    }
