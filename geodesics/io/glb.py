"""GLB and glTF: every triangle of the scene, placed as its nodes say, joined into one mesh."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.errors import BadContainer, IndexOutOfRange, InflatesTooFar, NoFaces
from geodesics.io.cells import triangles_of_strips
from geodesics.io.contents import Contents, Part
from geodesics.io.gltf_accessor import read_accessor
from geodesics.io.gltf_container import Gltf, open_gltf
from geodesics.io.gltf_nodes import Placed, placed_meshes, posed
from geodesics.notes import Note

TRIANGLES, STRIP, FAN = 4, 5, 6  # modes of a primitive (glTF 2.0, sec. 5.24)
MOST_BYTES = 1 << 28  # of positions, however often a mesh is placed, unless the file is as large itself; set by hand


@dataclass
class _Joined:
    """What has been joined so far."""

    vertices: list[Floats] = field(default_factory=list)
    faces: list[Integers] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)
    n_vertices: int = 0
    n_faces: int = 0
    others: int = 0  # pieces of points or lines


def read_glb(data: bytes, path: Path) -> Contents:
    """The meshes of a glTF file, each as often as it is placed; `BadContainer` when the description is no good."""
    try:
        with np.errstate(all="ignore"):  # numbers of a damaged file overflow, and are refused as a mesh
            return _read(open_gltf(data, path), len(data))
    except (KeyError, IndexError, TypeError, AttributeError, ValueError, OverflowError, RecursionError) as error:
        if hasattr(error, "code"):
            raise
        raise BadContainer(f"{path}: the glTF description is malformed ({error!r})") from error


def _read(gltf: Gltf, size: int) -> Contents:
    joined = _Joined()
    for place in placed_meshes(gltf):
        _add(gltf, place, joined, max(MOST_BYTES, size))
    if not joined.parts:
        if joined.others:
            raise NoFaces(f"{gltf.path}: the mesh has no faces, points or lines alone; they must be triangulated first")
        raise BadContainer(f"{gltf.path}: there are 0 mesh parts in the scene")
    notes = []
    if len(joined.parts) > 1:
        names = ", ".join(f"{part.name or 'unnamed'} ({len(part.faces)} faces)" for part in joined.parts[:5])
        more = ", ..." if len(joined.parts) > 5 else ""
        message = f"{len(joined.parts)} parts of the scene were joined into one mesh: {names}{more}"
        notes.append(Note("W222", "info", message, (), len(joined.parts)))
    if joined.others:
        notes.append(Note("W223", "info", f"{joined.others} parts of points or lines were passed over"))
    if gltf.longer:
        notes.append(Note("W220", "info", f"{gltf.longer} bytes behind the declared end were passed over"))
    vertices = np.concatenate([np.empty((0, 3)), *joined.vertices])
    faces = np.concatenate([np.empty((0, 3), dtype=np.int64), *joined.faces])
    return Contents(vertices, faces, notes, joined.parts)


def drawn(place: Placed) -> list[dict[str, Any]]:
    """The primitives of a placed mesh that are surfaces, in the order of the parts of the mesh that is read."""
    return [each for each in place.mesh["primitives"] if each.get("mode", TRIANGLES) in (TRIANGLES, STRIP, FAN)]


def _add(gltf: Gltf, place: Placed, joined: _Joined, most_bytes: int) -> None:
    """The primitives of a placed mesh; those that have the same positions share vertices."""
    first: dict[tuple[Any, ...], tuple[int, int]] = {}
    joined.others += len(place.mesh["primitives"]) - len(drawn(place))
    for primitive in drawn(place):
        gltf.refuse_draco(primitive)
        mode = primitive.get("mode", TRIANGLES)
        attributes = primitive["attributes"]
        used = (attributes["POSITION"], repr(primitive.get("targets")), attributes.get("JOINTS_0"))
        if used not in first:
            vertices = posed(gltf, place, primitive)
            if 24 * (joined.n_vertices + len(vertices)) > most_bytes:
                raise InflatesTooFar(f"{gltf.path}: placed as often as it says, the scene has over {most_bytes} bytes")
            first[used] = joined.n_vertices, len(vertices)
            joined.vertices.append(vertices)
            joined.n_vertices += len(vertices)
        start, n = first[used]
        faces = _triangles(gltf, primitive, mode, n)
        if place.mirrored:
            faces = faces[:, ::-1]
        name = place.name if len(place.mesh["primitives"]) == 1 else f"{place.name}.{len(joined.parts)}".lstrip(".")
        material = gltf.item("materials", primitive["material"]).get("name", "") if "material" in primitive else ""
        ends = joined.n_faces + len(faces)
        joined.parts.append(Part(name, str(material), range(start, start + n), range(joined.n_faces, ends)))
        joined.faces.append(faces + start)
        joined.n_faces = ends


def _triangles(gltf: Gltf, primitive: dict[str, Any], mode: int, n: int) -> Integers:
    """Triangles (m, 3) of a primitive of n vertices."""
    corners = np.arange(n, dtype=np.int64)
    if "indices" in primitive:
        table = read_accessor(gltf, primitive["indices"], "SCALAR").ravel()
        if table.dtype.kind != "u":
            raise BadContainer(f"{gltf.path}: accessor {primitive['indices']} holds no indices")
        corners = table.astype(np.int64)
        if len(corners) and corners.max() >= n:
            raise IndexOutOfRange(
                f"{gltf.path}: corner {corners.argmax()} of a mesh is vertex {corners.max()}, outside its {n} vertices"
            )
    if mode == STRIP:
        return triangles_of_strips((np.array([len(corners)]), corners))
    if mode == FAN:
        middle = corners[1:-1]
        return np.column_stack([np.full(len(middle), corners[0] if len(corners) else 0), middle, corners[2:]])
    if len(corners) % 3:
        listed = "" if "indices" in primitive else " in the accessor of its positions, as it has no indices,"
        raise BadContainer(
            f"{gltf.path}: a mesh has {len(corners)} corners{listed} where triangles need a multiple of 3"
        )
    return corners.reshape(-1, 3)
