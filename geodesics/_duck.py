"""Vertices and faces of the mesh objects of other libraries, recognised by their attributes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from geodesics.errors import NotTriangles


def arrays_of(mesh: Any) -> tuple[Any, Any] | None:
    """The vertices and triangles that `mesh` holds, unchecked; None when it is no mesh object."""
    for matches, arrays in _KINDS:
        if all(hasattr(mesh, name) for name in matches):
            return arrays(mesh)
    return None


def _pyvista(mesh: Any) -> tuple[Any, Any]:
    """PolyData keeps its faces flat: [3, i, j, k, 3, ...]."""
    flat = np.asarray(mesh.faces)
    if flat.ndim == 2:
        return mesh.points, flat
    if len(flat) % 4 or (flat[::4] != 3).any():
        raise NotTriangles("the object holds faces that are not triangles; call its triangulate() first")
    return mesh.points, flat.reshape(-1, 4)[:, 1:]


def _cells(mesh: Any) -> tuple[Any, Any]:
    """Cells by type, a name (meshio) or a VTK number (pyvista); lines and lone vertices are passed over."""
    cells = mesh.cells_dict
    if other := set(cells) - {"triangle", "line", "vertex", 5, 3, 1}:
        raise NotTriangles(f"the object holds cells that are not triangles: {sorted(map(str, other))}")
    return mesh.points, cells.get("triangle", cells.get(5))


_KINDS: list[tuple[tuple[str, ...], Callable[[Any], tuple[Any, Any]]]] = [
    (("vertices", "faces"), lambda mesh: (mesh.vertices, mesh.faces)),  # trimesh, and our own
    (("vertices", "triangles"), lambda mesh: (mesh.vertices, mesh.triangles)),  # Open3D
    (("points", "faces"), _pyvista),
    (("points", "cells_dict"), _cells),
]
