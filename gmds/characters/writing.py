"""What was carried, as a GLB file: a mesh for each part, on a skin that all share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics import vertex_normals
from geodesics.arrays import Floats, Integers
from geodesics.errors import CoordinateRange
from geodesics.io.gltf_nodes import world_matrices
from geodesics.mesh import Mesh
from gmds.characters.packing import Packer
from gmds.characters.scene import Scene
from gmds.characters.tree import move_nodes, node_for, start_of


@dataclass(frozen=True, eq=False)
class Carried:
    """What a surface of n vertices and m faces gets.

    `piece` (m,) of the scene, `weights` (n, b), `worlds` (4, 4) by node, `shapes` (k, n, 3) by place, `coordinates`
    (m, 3, 2) by name and `colours` (n, 4).
    """

    mesh: Mesh
    piece: Integers
    weights: Floats
    worlds: dict[int, Floats]
    shapes: dict[int, Floats]
    coordinates: dict[str, Floats]
    colours: NDArray[np.uint8] | None

    @property
    def names(self) -> list[str]:
        """Of the texture coordinates."""
        return sorted(self.coordinates)


def encoded(scene: Scene, carried: Carried) -> tuple[bytes, list[str]]:
    """A GLB file, and the names of the parts that are in it."""
    if np.abs(carried.mesh.vertices).max() > np.finfo(np.float32).max:
        raise CoordinateRange("coordinates do not fit the single precision of .glb; write .ply or .off instead")
    packer = Packer()
    tree = start_of(scene.gltf, packer, scene.look)
    if carried.worlds:
        move_nodes(tree, scene.gltf, carried.worlds)
        _add_skin(scene, carried, packer, tree)
    worlds = carried.worlds or world_matrices(scene.gltf)
    tree["meshes"] = []
    parts = []
    for number, place in enumerate(scene.places):
        pieces = [i for i, piece in enumerate(scene.pieces) if piece.place == number]
        if not pieces or not np.isin(carried.piece, pieces).any():
            continue
        mesh: dict[str, Any] = {name: place.mesh[name] for name in ("name", "extras") if name in place.mesh}
        if number in carried.shapes and place.weights:
            mesh["weights"] = list(place.weights)
        mesh["primitives"] = _primitives(scene, carried, number, pieces, packer)
        tree["meshes"].append(mesh)
        node = node_for(tree, place, scene.bones, worlds)
        node |= {"mesh": len(tree["meshes"]) - 1, **({"skin": 0} if carried.worlds else {})}
        parts.append(place.name)
    return packer.glb(tree), parts


def _add_skin(scene: Scene, carried: Carried, packer: Packer, tree: dict[str, Any]) -> None:
    """One skin of all bones, at rest where the nodes are."""
    inverse = np.stack([np.linalg.inv(carried.worlds[bone]).T.ravel() for bone in scene.bones])  # by columns
    inverse[:, 3:12:4], inverse[:, 15] = 0, 1
    first = next(scene.gltf.item("skins", place.skin) for place in scene.places if place.skin is not None)
    skin = {**first, "joints": scene.bones, "inverseBindMatrices": packer.table(inverse.astype(np.float32))}
    tree["skins"] = [skin]


def _primitives(scene: Scene, carried: Carried, place: int, pieces: list[int], packer: Packer) -> list[dict[str, Any]]:
    """The primitives of a part, which share vertices: those of its faces, or all where there is no other part."""
    mine = np.isin(carried.piece, pieces)
    faces = carried.mesh.faces[mine]
    columns = [faces.reshape(-1, 1), *(carried.coordinates[name][mine].reshape(-1, 2) for name in carried.names)]
    split, corner = np.unique(np.hstack(columns).astype(np.float64), axis=0, return_inverse=True)
    vertex = split[:, 0].astype(np.int64)
    if mine.all() and len(split) == len(np.unique(faces)):  # nothing is cut: vertices keep their numbers
        table = np.zeros((carried.mesh.n_vertices, split.shape[1]))
        table[vertex] = split
        corner, vertex, split = vertex[corner.ravel()], np.arange(len(table)), table
    corners = corner.reshape(-1, 3)
    attributes, targets = _attributes(scene, carried, place, vertex, split, packer)
    primitives = []
    for number in pieces:
        rows = carried.piece[mine] == number
        if not rows.any():
            continue
        old = scene.pieces[number].primitive
        primitive: dict[str, Any] = {name: old[name] for name in ("material", "extras") if name in old}
        variants = old.get("extensions", {}).get("KHR_materials_variants")
        primitive |= {"extensions": {"KHR_materials_variants": variants}} if variants else {}
        primitive |= {"attributes": attributes, "indices": packer.indices(corners[rows])}
        primitives.append(primitive | ({"targets": targets} if targets else {}))
    return primitives


def _attributes(
    scene: Scene, carried: Carried, place: int, vertex: Integers, split: Floats, packer: Packer
) -> tuple[dict[str, int], list[dict[str, int]]]:
    """Accessors of the vertices of a part and of its shapes."""
    mesh, shapes = carried.mesh, carried.shapes.get(place, np.zeros((0, carried.mesh.n_vertices, 3)))
    on = np.zeros(len(shapes))
    given = scene.places[place].weights[: len(shapes)]
    on[: len(given)] = given
    base = Mesh(mesh.vertices - np.einsum("k,kni->ni", on, shapes), mesh.faces)
    named = {name for piece in scene.pieces if piece.place == place for name in piece.primitive["attributes"]}
    found = {"POSITION": packer.attribute(base.vertices[vertex].astype(np.float32), bounds=True)}
    normals = vertex_normals(base)
    if "NORMAL" in named:
        found["NORMAL"] = packer.attribute(_upright(normals)[vertex].astype(np.float32))
    for number, name in enumerate(carried.names):
        if name in named:
            found[name] = packer.attribute(split[:, 1 + 2 * number : 3 + 2 * number].astype(np.float32))
    if carried.colours is not None and "COLOR_0" in named:
        found["COLOR_0"] = packer.attribute(carried.colours[vertex], normalized=True)
    if carried.worlds:
        joints, share = heaviest(carried.weights)
        found["JOINTS_0"] = packer.attribute(joints[vertex])
        found["WEIGHTS_0"] = packer.attribute(share[vertex])
    targets = [{"POSITION": packer.attribute(one[vertex].astype(np.float32), bounds=True)} for one in shapes]
    if "NORMAL" in named:
        for target, one in zip(targets, shapes, strict=True):
            turned = vertex_normals(Mesh(base.vertices + one, mesh.faces)) - normals
            target["NORMAL"] = packer.attribute(turned[vertex].astype(np.float32))
    return found, targets


def _upright(normals: Floats) -> Floats:
    """Normals of length 1, also where there are none, as the format asks for."""
    none = np.linalg.norm(normals, axis=1) < 0.5
    return np.where(none[:, None], (0.0, 0.0, 1.0), normals)


def heaviest(weights: Floats) -> tuple[NDArray[Any], NDArray[np.float32]]:
    """The four bones (n, 4) that hold each vertex most, and their weights; bones that do not are 0."""
    width = max(weights.shape[1], 4)
    padded = np.zeros((len(weights), width))
    padded[:, : weights.shape[1]] = weights
    order = np.argsort(-padded, axis=1, kind="stable")[:, :4]
    share = np.take_along_axis(padded, order, axis=1).astype(np.float32)
    share /= np.where(share.sum(axis=1, keepdims=True) > 0, share.sum(axis=1, keepdims=True), 1)
    joints = np.where(share > 0, order, 0)
    return joints.astype(np.uint8 if width <= 256 else np.uint16), share
