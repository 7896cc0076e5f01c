"""Meshes to bytes, one format each."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.errors import CoordinateRange, UnknownFormat
from geodesics.io.precision import offset
from geodesics.io.vtp_writing import encode_vtp
from geodesics.mesh import Mesh


def encode(mesh: Mesh, suffix: str) -> dict[str, bytes]:
    """The files, by suffix, that hold `mesh` in the format of `suffix`; text formats and PLY keep every bit."""
    v, f = mesh.vertices, mesh.faces
    if suffix == ".off":
        return {suffix: _lines([f"OFF\n{len(v)} {len(f)} 0"], _rows("", v), _rows("3 ", f))}
    if suffix == ".obj":
        return {suffix: _lines([f"# Vertices: {len(v)}\n# Faces: {len(f)}"], _rows("v ", v), _rows("f ", f + 1))}
    if suffix in (".vert", ".tri"):
        return {".vert": _lines(_rows("", v)), ".tri": _lines(_rows("", f + 1))}
    if suffix == ".ply":
        return {suffix: _ply(v, f)}
    if suffix in (".stl", ".glb"):
        return {suffix: _single_precision(mesh, suffix)}
    if suffix == ".vtp":
        return {suffix: encode_vtp(v, f)}
    raise UnknownFormat(
        f"no writer for {suffix!r}; end the name with .off, .obj, .ply, .stl, .glb, .vtp, .vert or .tri"
    )


def _rows(prefix: str, table: Floats | Integers) -> Iterable[str]:
    return (prefix + " ".join(map(repr, row)) for row in table.tolist())


def _lines(*blocks: Iterable[str]) -> bytes:
    return "".join(f"{line}\n" for block in blocks for line in block).encode("ascii")


def _ply(vertices: Floats, faces: Integers) -> bytes:
    """Binary PLY in double precision (the writer of trimesh has single precision only)."""
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    packed = np.empty(len(faces), dtype=[("degree", "u1"), ("corners", "<i4", 3)])
    packed["degree"] = 3
    packed["corners"] = faces
    return header.encode("ascii") + vertices.astype("<f8").tobytes() + packed.tobytes()


def _single_precision(mesh: Mesh, suffix: str) -> bytes:
    """STL or GLB, whose coordinates are float32 by definition; `CoordinateRange` when they do not fit."""
    import trimesh

    if np.abs(mesh.vertices).max() > np.finfo(np.float32).max:
        raise CoordinateRange(f"coordinates do not fit the single precision of {suffix}; write .ply or .off instead")
    center = offset(mesh) if suffix == ".glb" else None
    vertices = mesh.vertices if center is None else mesh.vertices - center
    shape = trimesh.Trimesh(vertices, mesh.faces, process=False, validate=False)
    if suffix == ".stl":
        return bytes(trimesh.exchange.stl.export_stl(shape))
    if center is None:
        return bytes(trimesh.exchange.gltf.export_glb(shape, include_normals=False))
    scene = trimesh.Scene()
    scene.add_geometry(shape, transform=trimesh.transformations.translation_matrix(center))
    return bytes(trimesh.exchange.gltf.export_glb(scene, include_normals=False))
