"""The checks at the door: arrays in, clean arrays or a typed error out."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics.errors import BadShape, EmptyMesh, IndexOutOfRange, NoFaces, NonFiniteVertex


def as_vertices(vertices: ArrayLike) -> NDArray[np.float64]:
    """A fresh C-ordered float64 copy (n, 3), or a `MeshError`."""
    v = np.array(vertices, dtype=np.float64, order="C")
    if v.size == 0:
        raise EmptyMesh("the mesh has no vertices")
    if v.ndim != 2 or v.shape[1] != 3:
        raise BadShape(f"vertices must have shape (n, 3), not {v.shape}")
    bad = np.flatnonzero(~np.isfinite(v).all(axis=1))
    if len(bad):
        raise NonFiniteVertex(f"{len(bad)} vertices are not finite, first {bad[:5].tolist()}")
    return v


def as_faces(faces: ArrayLike, n_vertices: int) -> NDArray[np.int64]:
    """A fresh C-ordered int64 copy (m, 3), or a `MeshError`."""
    f = np.array(faces, dtype=np.int64, order="C")
    if f.size == 0:
        raise NoFaces("the mesh has vertices but no faces")
    if f.ndim != 2 or f.shape[1] != 3:
        raise BadShape(f"faces must have shape (m, 3), not {f.shape}")
    bad = np.flatnonzero(((f < 0) | (f >= n_vertices)).any(axis=1))
    if len(bad):
        raise IndexOutOfRange(f"face {bad[0]} = {f[bad[0]]} refers outside the {n_vertices} vertices")
    return f
