"""A scene of the target of a map, carried to its source: parts, materials, bones and shapes to morph to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats, Integers
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.appearance.names import faces_under
from gmds.appearance.seams import carry_uv
from gmds.characters.own_look import dressed, on_every_part
from gmds.characters.scene import Scene, read_scene
from gmds.characters.skeleton import fitted
from gmds.characters.writing import Carried, encoded
from gmds.maps.point_map import PointMap
from gmds.maps.values import carry, carry_weights
from gmds.maps.vectors import turns

MOST = 4  # bones that hold a vertex: what every reader of glTF takes (glTF 2.0, sec. 3.7.3.3)


@dataclass(frozen=True)
class Told:
    """What was carried: parts, materials, texture coordinates, bones and shapes, by name or number; faces on seams."""

    parts: list[str]
    materials: list[str]
    coordinates: list[str]
    coloured: bool
    bones: int
    shapes: int
    faces_on_seams: int


def carry_scene(
    answer: PointMap, path: Path, *, rig: bool = True, most: int = MOST, own: Path | None = None
) -> tuple[bytes, Told]:
    """The source of a map as a GLB file with all that a scene of the target says of it.

    Each face of the source goes to the part and the material where its middle goes; parts keep their names, materials
    their textures. With `rig` there are also the skeleton, moved into the source (see `skeleton`), weights of bones
    interpolated on the target, and shapes to morph to, turned as the map turns the surface and resized as it does.
    The scene is as the file shows it: in that pose every vertex of the source is where it is in the source.

    Parameters
    ----------
    answer : Correspondence
        The map, of a source of n vertices.
    path : Path
        A GLB or glTF file whose faces are those of the target.
    rig : bool
        Whether bones and shapes to morph to are carried.
    most : int
        How many bones may hold a vertex, at most 4.
    own : Path, optional
        The file of the source, GLB or glTF: parts, materials, texture coordinates and colours are those of this file,
        and only bones and shapes to morph to come from the target.

    Returns
    -------
    content : bytes
        Of a .glb file.
    told : Told
        What is in it.

    Raises
    ------
    BadLook
        E217, where the file has other faces than the target, or is malformed.
    FormatError
        As `read_mesh` has them.

    See Also
    --------
    gmds.appearance.write_look : Colours or one texture, in other formats.
    """
    scene = read_scene(path, answer.target, rig=rig)
    mine = None if own is None else read_scene(own, answer.source, rig=False)
    source, face = answer.source, answer.points.face
    points = SurfacePoints(scene.surface, face, answer.points.barycentric)
    carried_uv, across = {}, np.zeros(source.n_faces, dtype=bool)
    for name, uv in scene.coordinates.items() if mine is None else ():
        carried_uv[name], torn = carry_uv(answer, uv)
        across |= torn
    weights = carry_weights(points, scene.weights, most=min(most, MOST)) if scene.bones else np.zeros((len(points), 0))
    worlds = {}
    if scene.bones:
        held = carry_weights(points, scene.weights)
        there, here = points.positions, source.vertices
        worlds = fitted(scene, held, there, here, _mass(source) * answer.valid)
    shapes = _shapes(scene, answer, points)
    n_shapes = sum(map(len, shapes.values()))
    if mine is None:
        piece = _piece_of_faces(scene, answer)
        colours = None if scene.colours is None else _colours(points, scene.colours)
    else:
        scene, shapes = dressed(scene, mine), on_every_part(shapes, mine)
        piece, carried_uv, colours = mine.piece_of_face, mine.coordinates, mine.colours
    carried = Carried(source, piece, weights, worlds, shapes, carried_uv, colours)
    content, parts = encoded(scene, carried)
    materials = (scene.look or scene.gltf).tree.get("materials", [])
    named = [str(each.get("name") or f"number {number}") for number, each in enumerate(materials)]
    return content, Told(
        parts, named, carried.names, carried.colours is not None, len(scene.bones), n_shapes, int(across.sum())
    )


def _mass(mesh: Mesh) -> Floats:
    """Areas of faces, shared among their corners; the same for all where there are none."""
    a, b, c = mesh.vertices[mesh.faces.T]
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    mass = np.bincount(mesh.faces.ravel(), np.repeat(area, 3), minlength=mesh.n_vertices)
    return np.asarray(mass, dtype=np.float64) if mass.sum() > 0 else np.ones(mesh.n_vertices)


def _piece_of_faces(scene: Scene, answer: PointMap) -> Integers:
    """The piece (m,) of each face of the source: that where its middle goes."""
    if len(scene.pieces) == 1:
        return np.zeros(answer.source.n_faces, dtype=np.int64)
    return scene.piece_of_face[faces_under(answer)]


def _shapes(scene: Scene, answer: PointMap, points: SurfacePoints) -> dict[int, Floats]:
    """Displacements (k, n, 3) of the source, by place."""
    if not scene.shapes:
        return {}
    turned = turns(answer) * _size(answer)
    return {
        place: np.stack([np.einsum("nba,nb->na", turned, points.interpolate(shape)) for shape in shapes])
        for place, shapes in scene.shapes.items()
    }


def _size(answer: PointMap) -> float:
    """How much longer edges are on the source than where they go, by the median."""
    faces = answer.source.faces
    here, there = (
        np.linalg.norm(place[faces] - place[np.roll(faces, 1, axis=1)], axis=2)
        for place in (answer.source.vertices, answer.points.positions)
    )
    ratio = here[there > 0] / there[there > 0]
    return float(np.median(ratio)) if len(ratio) else 1.0


def _colours(points: SurfacePoints, colours: NDArray[np.uint8]) -> NDArray[np.uint8]:
    return np.asarray(carry(points, colours, labels=False), dtype=np.uint8)
