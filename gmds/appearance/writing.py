"""Meshes with colours, textures and values, for other programs: .obj, .ply, .glb, .vtp."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh
from geodesics.io import atomic_write
from geodesics.io.precision import offset
from geodesics.io.vtp_writing import encode_vtp
from gmds.appearance.names import FaceNames, named_faces
from gmds.appearance.polygons import Polygons, as_triangles, with_coordinates
from gmds.appearance.reading import BadLook, Look

ENDINGS = (".obj", ".ply", ".glb", ".vtp")
Values = Mapping[str, NDArray[Any]]


def write_look(
    path: Path, mesh: Mesh, look: Look, values: Values | None = None, polygons: Polygons | None = None
) -> list[Path]:
    """Write a mesh with its look, or with values on its vertices; each file is whole or untouched.

    Parameters
    ----------
    path : Path
        The ending names the format. .obj: colours behind positions, or texture coordinates with a .mtl and a .png
        beside it; names of faces. .glb: colours, or texture coordinates and the image, with vertices doubled along
        seams, as the format asks for. .ply: colours and values. .vtp (ParaView): values, and colours as one of them.
    mesh : Mesh
        Of n vertices.
    look : Look
        Colours or texture.
    values : mapping from str to arrays of shape (n,) or (n, k), optional
        Numbers on vertices.
    polygons : Polygons, optional
        Faces that are written in place of the triangles (`polygons_of`); .glb has triangles all the same. A polygon
        whose triangles lie on different sides of a seam is written as triangles.

    Returns
    -------
    list of Path
        The files that were written.

    Raises
    ------
    BadLook
        E217, for what a format cannot keep.
    OSError
        When a file cannot be written.
    """
    ending, values = path.suffix.lower(), values or {}
    if look.uv is not None and ending not in (".obj", ".glb"):
        raise BadLook(f"{path}: a texture is kept in .obj or .glb")
    if values and ending not in (".ply", ".vtp"):
        raise BadLook(f"{path}: values are kept in .ply or .vtp; .obj and .glb have colours")
    wrong = [name for name, array in values.items() if np.asarray(array).dtype.kind not in "fiub"]
    if wrong:
        raise BadLook(f"{path}: {wrong[0]} holds words; number them to keep them in {ending}")
    faces = as_triangles(mesh, look.uv) if polygons is None else polygons
    if polygons is not None and look.uv is not None:
        faces = with_coordinates(polygons, look.uv)
    if ending == ".obj":
        files = _obj(path, mesh, look, faces)
    elif ending == ".glb":
        files = {path: _glb(mesh, look)}
    else:
        files = {path: (_ply if ending == ".ply" else _vtp)(mesh, look, values, faces)}
    for name, content in files.items():
        with atomic_write(name) as stream:
            stream.write(content)
    return list(files)


def _obj(path: Path, mesh: Mesh, look: Look, polygons: Polygons) -> dict[Path, bytes]:
    rows = [" ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    if look.colours is not None:  # a custom that most programs follow
        colours = np.round(look.colours[:, :3] / 255, 4).tolist()
        rows = [f"{row} {' '.join(map(repr, colour))}" for row, colour in zip(rows, colours, strict=True)]
    vertices = [f"v {row}" for row in rows]
    corners = (polygons.corners + 1).tolist()
    libraries = [] if look.names is None else [f"mtllib {name}" for name in look.names.libraries]
    if polygons.uv is None:
        return {path: _lines(libraries, vertices, _face_lines(polygons, list(map(str, corners)), look.names))}
    places, index = np.unique(polygons.uv, axis=0, return_inverse=True)
    numbered = zip(corners, (index.ravel() + 1).tolist(), strict=True)
    names = look.names
    if look.image is not None and (names is None or not names.materials):
        names = FaceNames((("", "", "carried"),), np.zeros(mesh.n_faces, dtype=np.int64))
    faces = _face_lines(polygons, [f"{v}/{t}" for v, t in numbered], names)
    coordinates = ["vt " + " ".join(map(repr, row)) for row in places.tolist()]
    if look.image is None:
        return {path: _lines(libraries, vertices, coordinates, faces)}
    name = re.sub(r"\s", "_", path.stem)  # names with blanks are not read by all
    material, image = path.with_name(f"{name}.mtl"), path.with_name(f"{name}.png")
    head = [f"mtllib {material.name}"]
    used = names.materials if names is not None else ()
    about = [line for each in used for line in (f"newmtl {each}", "Kd 1 1 1", f"map_Kd {image.name}")]
    return {
        image: _png(look.image),
        material: _lines(about),
        path: _lines(head, vertices, coordinates, faces),
    }


def _face_lines(polygons: Polygons, corners: list[str], names: FaceNames | None) -> list[str]:
    ends = np.cumsum(polygons.sizes).tolist()
    lines = ["f " + " ".join(corners[start:end]) for start, end in zip([0, *ends], ends, strict=False)]
    triangles = polygons.sizes - 2
    return lines if names is None else [*named_faces(names, np.cumsum(triangles) - triangles, lines)]


def _lines(*blocks: list[str]) -> bytes:
    return "".join(f"{line}\n" for block in blocks for line in block).encode("utf-8")


def _png(image: Any) -> bytes:
    out = io.BytesIO()
    image.save(out, format="PNG")
    return out.getvalue()


def _ply(mesh: Mesh, look: Look, values: Values, polygons: Polygons) -> bytes:
    """Binary, in double precision; every column of the values is a property."""
    names = {"f8": "double", "f4": "float", "i4": "int", "u1": "uchar"}
    columns: dict[str, NDArray[Any]] = dict(zip("xyz", mesh.vertices.T, strict=True))
    if look.colours is not None:
        columns |= zip(("red", "green", "blue", "alpha"), look.colours.T, strict=False)
    for name, array in values.items():
        table = np.asarray(array).reshape(mesh.n_vertices, -1)
        titles = [name] if table.shape[1] == 1 else [f"{name}_{i}" for i in range(table.shape[1])]
        columns |= zip((re.sub(r"\W", "_", title) for title in titles), table.T, strict=True)
    kinds = {name: _ply_kind(column) for name, column in columns.items()}
    rows = np.empty(mesh.n_vertices, dtype=[(name, f"<{kind}") for name, kind in kinds.items()])
    for name, column in columns.items():
        rows[name] = column
    properties = "".join(f"property {names[kind]} {name}\n" for name, kind in kinds.items())
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {mesh.n_vertices}\n{properties}"
    wide = int(polygons.sizes.max(initial=0)) > 255
    header += f"element face {len(polygons.sizes)}\nproperty list {'int' if wide else 'uchar'} int vertex_indices\n"
    return f"{header}end_header\n".encode("ascii") + rows.tobytes() + _packed(polygons, "<i4" if wide else "<u1")


def _packed(polygons: Polygons, kind: str) -> bytes:
    """Each face as a number of this kind, how many corners it has, and its vertices."""
    width, sizes = np.dtype(kind).itemsize, polygons.sizes
    start = np.cumsum(width + 4 * sizes) - (width + 4 * sizes)
    content = np.zeros(int((width + 4 * sizes).sum()), dtype=np.uint8)
    content[start[:, None] + np.arange(width)] = sizes.astype(kind)[:, None].view(np.uint8)
    within = np.arange(len(polygons.corners)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    at = np.repeat(start, sizes) + width + 4 * within
    content[at[:, None] + np.arange(4)] = polygons.corners.astype("<i4")[:, None].view(np.uint8)
    return content.tobytes()


def _ply_kind(column: NDArray[Any]) -> str:
    if column.dtype.kind == "f":
        return "f4" if column.dtype.itemsize <= 4 else "f8"
    if column.dtype == np.uint8 or column.dtype.kind == "b":
        return "u1"
    fits = len(column) == 0 or (column.min() >= -(2**31) and column.max() < 2**31)
    return "i4" if fits else "f8"


def _vtp(mesh: Mesh, look: Look, values: Values, polygons: Polygons) -> bytes:
    named = dict(values) if look.colours is None else {**values, "colours": look.colours}
    return encode_vtp(mesh.vertices, polygons.corners, named, polygons.sizes)


def _glb(mesh: Mesh, look: Look) -> bytes:
    """Far from the origin around the middle, with the place in the node, as `write_mesh` does."""
    import trimesh

    center = offset(mesh)
    there = np.zeros(3) if center is None else center
    if look.uv is None:
        place, faces = mesh.vertices - there, mesh.faces
        shape = trimesh.Trimesh(place, faces, vertex_colors=look.colours, process=False, validate=False)
    else:
        corners = np.column_stack([mesh.faces.reshape(-1, 1).astype(np.float64), look.uv.reshape(-1, 2)])
        split, index = np.unique(corners, axis=0, return_inverse=True)
        texture = {"baseColorTexture": look.image, "metallicFactor": 0.0, "roughnessFactor": 1.0}
        material = trimesh.visual.material.PBRMaterial(**texture)
        visual = trimesh.visual.TextureVisuals(uv=split[:, 1:], material=material)
        place, faces = mesh.vertices[split[:, 0].astype(np.int64)] - there, index.reshape(-1, 3)
        shape = trimesh.Trimesh(place, faces, visual=visual, process=False, validate=False)
    if center is None:
        return bytes(trimesh.exchange.gltf.export_glb(shape, include_normals=False))
    scene = trimesh.Scene()
    scene.add_geometry(shape, transform=trimesh.transformations.translation_matrix(center))
    return bytes(trimesh.exchange.gltf.export_glb(scene, include_normals=False))
