"""Points anywhere on a surface, as face and barycentric weights."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics.errors import BadShape, IndexOutOfRange
from geodesics.mesh import Mesh
from geodesics._memo import memoized


@dataclass(frozen=True, eq=False, repr=False)
class SurfacePoints:
    """Points on a mesh: face (p,) int64 and barycentric (p, 3) float64, weights >= 0 summing to 1.

    Raises `MeshError` when a face does not exist or the shapes disagree.
    """

    mesh: Mesh
    face: NDArray[np.int64]
    barycentric: NDArray[np.float64]

    def __init__(self, mesh: Mesh, face: ArrayLike, barycentric: ArrayLike) -> None:
        f = np.array(face, dtype=np.int64).reshape(-1)
        b = np.array(barycentric, dtype=np.float64)
        if b.shape != (len(f), 3):
            raise BadShape(f"barycentric must have shape ({len(f)}, 3), not {b.shape}")
        bad = np.flatnonzero((f < 0) | (f >= mesh.n_faces))
        if len(bad):
            raise IndexOutOfRange(f"point {bad[0]} lies on face {f[bad[0]]}; the mesh has {mesh.n_faces} faces")
        f.setflags(write=False)
        b.setflags(write=False)
        object.__setattr__(self, "mesh", mesh)
        object.__setattr__(self, "face", f)
        object.__setattr__(self, "barycentric", b)

    @classmethod
    def at_vertices(cls, mesh: Mesh, indices: ArrayLike) -> SurfacePoints:
        """The points at mesh vertices `indices` (p,); `MeshError` if one is on no face."""
        indices = np.asarray(indices, dtype=np.int64).reshape(-1)
        bad = np.flatnonzero((indices < 0) | (indices >= mesh.n_vertices))
        if len(bad):
            raise IndexOutOfRange(f"vertex {indices[bad[0]]} does not exist; the mesh has {mesh.n_vertices} vertices")
        corner = _corner_of_vertex(mesh)[indices]
        lonely = np.flatnonzero(corner < 0)
        if len(lonely):
            raise IndexOutOfRange(f"vertex {indices[lonely[0]]} is on no face")
        return cls(mesh, corner // 3, np.eye(3)[corner % 3])

    def __len__(self) -> int:
        return len(self.face)

    def __getitem__(self, index: ArrayLike | slice) -> SurfacePoints:
        index = index if isinstance(index, slice) else np.atleast_1d(np.asarray(index))
        return SurfacePoints(self.mesh, self.face[index], self.barycentric[index])

    def __repr__(self) -> str:
        return f"SurfacePoints({len(self)} on {self.mesh!r})"

    @property
    def positions(self) -> NDArray[np.float64]:
        """Positions in space, shape (p, 3)."""
        return self.interpolate(self.mesh.vertices)

    def interpolate(self, values: ArrayLike) -> NDArray[np.float64]:
        """Per-vertex values (n,) or (n, c), linearly interpolated at the points: (p,) or (p, c)."""
        corners = np.asarray(values)[self.mesh.faces[self.face]]
        return np.einsum("pk,pk...->p...", self.barycentric, corners)

    def nearest_vertices(self) -> NDArray[np.int64]:
        """The corner with the largest weight, shape (p,)."""
        return self.mesh.faces[self.face, self.barycentric.argmax(axis=1)]


@memoized
def _corner_of_vertex(mesh: Mesh) -> NDArray[np.int64]:
    """For each vertex one corner index 3 * face + slot, -1 where it is on no face."""
    corner = np.full(mesh.n_vertices, -1, dtype=np.int64)
    corner[mesh.faces.ravel()[::-1]] = np.arange(3 * mesh.n_faces - 1, -1, -1)
    return corner
