"""What a glTF scene says of its surface beside the triangles: parts, materials, bones, shapes to morph to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats, Integers
from geodesics.io.contents import Contents
from geodesics.io.glb import drawn, read_glb
from geodesics.io.gltf_accessor import read_accessor
from geodesics.io.gltf_container import Gltf, open_gltf
from geodesics.io.gltf_nodes import Placed, motions, placed_meshes, same_length, skin_of
from geodesics.io.opening import read_bytes
from geodesics.mesh import Mesh
from gmds.appearance.reading import BadLook, refuse_other_faces
from gmds.appearance.scenes import colours_of, coordinates_of


@dataclass(frozen=True, eq=False)
class Piece:
    """A primitive where it is placed: number of the place, description, and its vertices and faces."""

    place: int
    primitive: dict[str, Any]
    vertices: slice
    faces: slice


@dataclass(frozen=True, eq=False)
class Scene:
    """A glTF scene of n vertices and m faces, all in the pose of the file.

    `bones` are numbers of nodes, a column each of `weights` (n, b), whose rows sum to 1; both are empty where there is
    no skin. `shapes` are displacements (k, n, 3) by place; `coordinates` (m, 3, 2) by their names in the file.
    `look` has the materials, where they are of another file.
    """

    gltf: Gltf
    surface: Mesh
    places: list[Placed]
    pieces: list[Piece]
    bones: list[int]
    weights: Floats
    shapes: dict[int, Floats]
    coordinates: dict[str, Floats]
    colours: NDArray[np.uint8] | None
    look: Gltf | None = None

    @property
    def piece_of_face(self) -> Integers:
        """The number (m,) of the piece that each face belongs to."""
        sizes = [piece.faces.stop - piece.faces.start for piece in self.pieces]
        return np.repeat(np.arange(len(sizes)), sizes)


def read_scene(path: Path, mesh: Mesh, *, rig: bool) -> Scene:
    """The scene of a GLB or glTF file that has the faces of `mesh`, with bones and shapes if `rig`.

    `BadLook` where it has others, or is malformed.
    """
    data = read_bytes(path)
    contents, gltf = read_glb(data, path), open_gltf(data, path)
    refuse_other_faces(contents, mesh, path)
    try:
        with np.errstate(all="ignore"):  # numbers of a damaged file overflow
            return _read(gltf, contents, rig)
    except (KeyError, IndexError, TypeError, AttributeError, ValueError, OverflowError) as error:
        if hasattr(error, "code"):
            raise
        raise BadLook(f"{path}: its materials or bones are malformed ({type(error).__name__}: {error})") from error


def _read(gltf: Gltf, contents: Contents, rig: bool) -> Scene:
    places = list(placed_meshes(gltf))
    drawings = [(number, each) for number, place in enumerate(places) for each in drawn(place)]
    pieces = [
        Piece(number, each, _slice(part.vertices), _slice(part.faces))
        for (number, each), part in zip(drawings, contents.parts, strict=True)
    ]
    n, m = len(contents.vertices), len(contents.triangles)
    names = sorted({name for piece in pieces for name in piece.primitive["attributes"] if name[:9] == "TEXCOORD_"})
    coordinates = {name: np.zeros((m, 3, 2)) for name in names}
    colours = np.full((n, 4), 255, dtype=np.uint8)
    for piece in pieces:
        corners = contents.triangles[piece.faces] - piece.vertices.start
        for name in set(names) & set(piece.primitive["attributes"]):
            coordinates[name][piece.faces] = coordinates_of(gltf, piece.primitive, name)[corners]
        if "COLOR_0" in piece.primitive["attributes"]:
            colours[piece.vertices] = colours_of(gltf, piece.primitive)
    bones, weights = _skin(gltf, places, pieces, n) if rig else ([], np.zeros((n, 0)))
    return Scene(
        gltf=gltf,
        surface=Mesh(contents.vertices, contents.triangles),
        places=places,
        pieces=pieces,
        bones=bones,
        weights=weights,
        shapes=_shapes(gltf, places, pieces, n) if rig else {},
        coordinates=coordinates,
        colours=colours if any("COLOR_0" in piece.primitive["attributes"] for piece in pieces) else None,
    )


def _slice(rows: range) -> slice:
    return slice(rows.start, rows.stop)


def _skin(gltf: Gltf, places: list[Placed], pieces: list[Piece], n: int) -> tuple[list[int], Floats]:
    """Nodes that hold vertices, and how much: joints of all skins, then nodes of parts that no joint holds."""
    skins = [gltf.item("skins", place.skin) for place in places if place.skin is not None]
    if not skins:
        return [], np.zeros((n, 0))
    bones = list(dict.fromkeys(joint for skin in skins for joint in skin["joints"]))
    bones += [node for place in places if (node := place.node) is not None and node not in bones]
    column = {bone: number for number, bone in enumerate(bones)}
    weights = np.zeros((n, len(bones)))
    for piece in pieces:
        place, rows = places[piece.place], np.arange(piece.vertices.start, piece.vertices.stop)
        weights[rows] = 0
        if place.skin is not None and "JOINTS_0" in piece.primitive["attributes"]:
            joint, share = skin_of(gltf, place, piece.primitive, rows)
            there = np.array([column[node] for node in gltf.item("skins", place.skin)["joints"]])
            np.add.at(weights, (rows[:, None], there[joint]), share)
        weights[rows[weights[rows].sum(axis=1) == 0], column[place.node or 0]] = 1  # as its node does
    n_joints = len({joint for skin in skins for joint in skin["joints"]})
    kept = [number for number in range(len(bones)) if number < n_joints or weights[:, number].any()]
    return [bones[number] for number in kept], weights[:, kept]


def _shapes(gltf: Gltf, places: list[Placed], pieces: list[Piece], n: int) -> dict[int, Floats]:
    """Displacements of the shapes to morph to, turned as the skin turns the surface in the pose of the file."""
    found: dict[int, Floats] = {}
    for piece in pieces:
        targets, attributes = piece.primitive.get("targets", []), piece.primitive["attributes"]
        if not targets:
            continue
        positions = read_accessor(gltf, attributes["POSITION"], "VEC3").astype(np.float64)
        linear = motions(gltf, places[piece.place], piece.primitive, positions)[:, :, :3]
        shapes = found.setdefault(piece.place, np.zeros((len(targets), n, 3)))
        for shape, target in zip(shapes, targets, strict=True):
            if "POSITION" in target:
                moved = same_length(gltf, target["POSITION"], "VEC3", positions).astype(np.float64)
                shape[piece.vertices] = np.einsum("nij,nj->ni", linear, moved)
    return found
