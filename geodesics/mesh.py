"""A triangle mesh: checked once at the door, then frozen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics import intrinsic
from geodesics._duck import arrays_of
from geodesics._validation import as_faces, as_indices, as_vertices, check_area
from geodesics.arrays import Floats, Integers
from geodesics.errors import BadShape


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh with vertices (n, 3) float64 and faces (m, 3) int64, both read-only copies.

    `Mesh(vertices, faces)` takes anything array-like; `Mesh(other)` takes a mesh object of trimesh, pyvista, meshio
    or Open3D. Coordinates may have any unit. Raises `MeshError` naming the first offending vertex or face.
    """

    vertices: Floats
    faces: Integers

    def __init__(self, vertices: ArrayLike | Any, faces: ArrayLike | None = None) -> None:
        if faces is None and (found := arrays_of(vertices)) is not None:
            vertices, faces = found
        v = as_vertices(vertices)
        f = as_faces(faces, len(v))
        check_area(v, f)
        v.setflags(write=False)
        f.setflags(write=False)
        object.__setattr__(self, "vertices", v)
        object.__setattr__(self, "faces", f)

    @classmethod
    def from_object(cls, mesh: Any) -> Mesh:
        """A `Mesh` from a mesh object of trimesh, pyvista, meshio or Open3D; a `Mesh` is returned as it is.

        Raises `TypeError` for anything else, and `MeshError` for what the object holds.
        """
        if isinstance(mesh, cls):
            return mesh
        found = arrays_of(mesh)
        if found is None:
            raise TypeError(
                f"a mesh is expected, not {type(mesh).__name__}; for example geodesics.Mesh(vertices, faces), "
                "geodesics.read_mesh(path), or a mesh object of trimesh, pyvista or meshio"
            )
        return cls(*found)

    def __repr__(self) -> str:
        return f"Mesh({len(self.vertices)} vertices, {len(self.faces)} faces)"

    def __getstate__(self) -> dict[str, Any]:
        """Memoised results are not part of the mesh."""
        return {"vertices": self.vertices, "faces": self.faces}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Unpickled arrays are frozen again."""
        for name, array in state.items():
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    @property
    def n_faces(self) -> int:
        """Number of faces."""
        return len(self.faces)

    @property
    def area(self) -> float:
        """Area of the surface, in squared units of the coordinates."""
        return float(intrinsic.areas(intrinsic.squared_lengths(self.vertices, self.faces)).sum())


def triangulate(faces: ArrayLike) -> Integers:
    """Polygons (m, k) split about their first corner into triangles (m (k - 2), 3), in order; no vertex is added.

    Raises `MeshError` when the array is not (m, k) with k >= 3 or does not hold whole numbers from 0.
    """
    f = as_indices(faces, 2**63 - 1, "face", "possible vertices")
    if f.ndim != 2 or f.shape[1] < 3:
        raise BadShape(f"faces must have shape (m, k) with k >= 3, not {f.shape}")
    slots = [(0, i, i + 1) for i in range(1, f.shape[1] - 1)]
    return np.ascontiguousarray(f[:, slots].reshape(-1, 3))
