"""What a file says of how its surface looks, face by face in the order in which the mesh is read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats, Integers
from geodesics.io.contents import Contents
from geodesics.io.obj import read_obj, statements
from geodesics.io.ply import read_columns, read_ply
from geodesics.io.ply_header import Element, read_header
from geodesics.io.text import numbers, whole
from gmds.appearance.names import FaceNames, names_in_obj, names_of_parts
from gmds.appearance.scenes import scene_look

# Names of texture coordinates of a vertex in a PLY file, by who writes them: Blender, MeshLab, Open3D and others.
UV_NAMES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("tex_u", "tex_v"))
WEDGES = ("texcoord", "texcoords")  # those of the corners of a face
HIGHEST = {"u1": 255.0, "u2": 65535.0}  # of a colour, by the type of its numbers; others go from 0 to 1


@dataclass(frozen=True, eq=False)
class Shown:
    """Contents of a file with colours (n, 3 or 4), texture coordinates (m, 3, 2), an image, and what is not kept."""

    contents: Contents
    colours: NDArray[np.uint8] | None = None
    uv: Floats | None = None
    image: Any = None
    materials: tuple[str, ...] = ()
    names: FaceNames | None = None


def shown(data: bytes, kind: str, path: Path) -> Shown:
    """The look of an OBJ, PLY or glTF file."""
    readers: dict[str, Callable[[bytes, Path], Shown]] = {"obj": _obj, "ply": _ply}
    if kind in readers:
        return readers[kind](data, path)
    found = Shown(*scene_look(data, path))
    return replace(found, names=names_of_parts(found.contents))


def _obj(data: bytes, path: Path) -> Shown:
    contents = read_obj(data, path)
    vertex_rows, uv_rows, at = [], [], []
    for row in statements(data, path):
        word = row.words[0]
        if word == "v":
            vertex_rows.append(row)
        elif word == "vt":
            uv_rows.append(row)
        elif word in ("f", "fo"):
            at += [_texture_corner(corner, len(uv_rows), f"{path}, line {row.line}") for corner in row.words[1:]]
    names = names_in_obj(data, path, contents)
    materials = () if names is None else names.materials
    used = np.array(at, dtype=np.int64)
    if (used >= 0).any() and (used < len(uv_rows)).all() and contents.slots is not None:
        places = np.vstack([numbers(uv_rows, 1, path, 2), np.zeros(2)])  # -1, the last, is none
        return Shown(contents, uv=places[used[contents.slots]], materials=materials, names=names)
    if vertex_rows and all(len(row.words) in (7, 8) for row in vertex_rows):
        values = numbers(vertex_rows, len(vertex_rows[0].words) - 3, path)
        colours = _as_bytes(values, 255.0 if values.max(initial=0) > 1 else 1.0)
        return Shown(contents, colours, materials=materials, names=names)
    return Shown(contents, materials=materials, names=names)


def _texture_corner(corner: str, so_far: int, place: str) -> int:
    """The texture coordinate of a corner `v/vt/vn`, from 0; -1 where it has none."""
    parts = corner.split("/")
    if len(parts) < 2 or not parts[1]:
        return -1
    written = whole(parts[1], place)
    return max(written - 1 if written > 0 else so_far + written, -1)


def _ply(data: bytes, path: Path) -> Shown:
    contents = read_ply(data, path)
    header = read_header(data, path)
    columns, _ = read_columns(data, header, path)
    vertex, face = header.elements["vertex"], header.elements.get("face")
    uv = None
    wedge = face.find(*WEDGES) if face is not None else -1
    pair = next((pair for pair in UV_NAMES if min(vertex.find(name) for name in pair) >= 0), None)
    if face is not None and wedge >= 0 and face.properties[wedge].size and contents.slots is not None:
        sizes, flat = columns["face"].number_lists(wedge)
        corners, _ = columns["face"].lists(face.find("vertex_indices", "vertex_index"))
        uv = _of_wedges(sizes, flat, corners, contents.slots)
    elif pair is not None and vertex.length:
        uv = columns["vertex"].numbers([vertex.find(name) for name in pair])[contents.triangles]
    if uv is not None and np.isfinite(uv).all():
        return Shown(contents, uv=uv)
    return Shown(contents, _ply_colours(vertex, columns["vertex"]))


def _of_wedges(sizes: Integers, flat: Floats, corners: Integers, slots: Integers) -> Floats | None:
    """Coordinates (m, 3, 2) from lists of two numbers a corner; faces without a list get 0."""
    if not ((sizes == 2 * corners) | (sizes == 0)).all() or not len(flat):
        return None
    table = np.zeros((int(corners.sum()), 2))
    table[np.repeat(sizes > 0, corners)] = flat.reshape(-1, 2)
    return np.asarray(table[slots])


def _ply_colours(vertex: Element, columns: Any) -> NDArray[np.uint8] | None:
    for names in (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue")):
        places = [vertex.find(name) for name in names]
        if min(places) >= 0 and vertex.length:
            places += [place for name in ("alpha", "a") if (place := vertex.find(name)) >= 0][:1]
            return _as_bytes(columns.numbers(places), HIGHEST.get(vertex.properties[places[0]].kind, 1.0))
    return None


def _as_bytes(values: Floats, highest: float) -> NDArray[np.uint8]:
    with np.errstate(invalid="ignore"):
        return np.rint(np.clip(np.nan_to_num(values) / highest, 0, 1) * 255).astype(np.uint8)
