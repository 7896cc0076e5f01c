"""A triangle mesh: checked once at the door, then frozen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics._validation import as_faces, as_vertices


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """A triangle mesh with vertices (n, 3) float64 and faces (m, 3) int64, both read-only copies.

    Raises `MeshError` naming the first offending vertex or face.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]

    def __init__(self, vertices: ArrayLike, faces: ArrayLike) -> None:
        v = as_vertices(vertices)
        f = as_faces(faces, len(v))
        v.setflags(write=False)
        f.setflags(write=False)
        object.__setattr__(self, "vertices", v)
        object.__setattr__(self, "faces", f)

    def __repr__(self) -> str:
        return f"Mesh({len(self.vertices)} vertices, {len(self.faces)} faces)"

    def __getstate__(self) -> dict[str, Any]:
        """Memoised results are not part of the mesh."""
        return {"vertices": self.vertices, "faces": self.faces}

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    @property
    def n_faces(self) -> int:
        """Number of faces."""
        return len(self.faces)
