"""Meshes to bytes, one format each."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.errors import CoordinateRange, UnknownFormat
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
    raise UnknownFormat(f"no writer for {suffix!r}; end the name with .off, .obj, .ply, .stl, .glb, .vert or .tri")


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
    shape = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False, validate=False)
    if suffix == ".stl":
        return bytes(trimesh.exchange.stl.export_stl(shape))
    return bytes(trimesh.exchange.gltf.export_glb(shape, include_normals=False))
