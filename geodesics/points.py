"""Points anywhere on a surface, as face and barycentric weights."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics._validation import as_indices, as_vertices, as_weights
from geodesics.arrays import Bools, Floats, Integers
from geodesics.barycentric import combination
from geodesics.caching import memoized
from geodesics.closest import closest_on_triangles
from geodesics.errors import BadShape, IndexOutOfRange
from geodesics.mesh import Mesh


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points anywhere on a mesh, each as a face and three barycentric weights.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices and m faces.
    face : array_like of shape (p,)
        The face of each point, from 0 to m - 1.
    barycentric : array_like of shape (p, 3)
        Weights of the corners of that face: not negative, and summing to 1. Rounding errors are removed.

    Attributes
    ----------
    mesh : Mesh
        The surface.
    face : int64 array of shape (p,)
        The face of each point, read-only.
    barycentric : float64 array of shape (p, 3)
        The weights of its corners, read-only.

    Raises
    ------
    MeshError
        Naming the point whose face does not exist (E105) or whose weights are not finite, negative or of another sum
        (E115), and for arrays of the wrong shape (E108).

    See Also
    --------
    geodesics.tracing.walk : Points moved along the surface.

    Examples
    --------
    >>> import geodesics
    >>> triangle = geodesics.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    >>> middle = geodesics.SurfacePoints(triangle, [0], [[0.5, 0.5, 0]])  # of the edge from vertex 0 to vertex 1
    >>> middle.positions.tolist()
    [[1.5, 0.0, 0.0]]
    """

    mesh: Mesh
    face: Integers
    barycentric: Floats

    def __init__(self, mesh: Mesh, face: ArrayLike, barycentric: ArrayLike) -> None:
        mesh = Mesh.from_object(mesh)
        f = as_indices(face, mesh.n_faces, "point", "faces")
        if f.ndim != 1:
            raise BadShape(f"face must have shape (p,), one face per point, not {f.shape}")
        b = as_weights(barycentric, len(f))
        f.setflags(write=False)
        b.setflags(write=False)
        object.__setattr__(self, "mesh", mesh)
        object.__setattr__(self, "face", f)
        object.__setattr__(self, "barycentric", b)

    def __reduce__(self) -> tuple[Any, ...]:
        """Unpickled points are checked and frozen again."""
        return SurfacePoints, (self.mesh, self.face, self.barycentric)

    @classmethod
    def at_vertices(cls, mesh: Mesh, indices: ArrayLike) -> SurfacePoints:
        """The points at vertices of the mesh.

        Parameters
        ----------
        mesh : Mesh
            The surface, of n vertices.
        indices : array_like of shape (p,)
            Vertices, from 0 to n - 1.

        Returns
        -------
        SurfacePoints
            One point per index, on some face of that vertex.

        Raises
        ------
        MeshError
            E105 when a vertex does not exist, or is on no face.
        """
        mesh = Mesh.from_object(mesh)
        vertices = as_indices(indices, mesh.n_vertices, "point", "vertices").reshape(-1)
        corner = _corner_of_vertex(mesh)[vertices]
        lonely = np.flatnonzero(corner < 0)
        if len(lonely):
            raise IndexOutOfRange(f"vertex {vertices[lonely[0]]} is on no face, so it is no point of the surface")
        return cls(mesh, corner // 3, np.eye(3)[corner % 3])

    @classmethod
    def closest(cls, mesh: Mesh, positions: ArrayLike) -> SurfacePoints:
        """The points of the surface closest in space to given positions.

        Parameters
        ----------
        mesh : Mesh
            The surface.
        positions : array_like of shape (p, 3)
            Positions, in the unit of the mesh.

        Returns
        -------
        SurfacePoints
            One point per position.

        Raises
        ------
        MeshError
            For positions that could not be vertices of a `Mesh` (E101 - E103, E107, E108).
        """
        mesh = Mesh.from_object(mesh)
        p = as_vertices(positions)
        center, size = mesh.vertices.mean(axis=0), np.ptp(mesh.vertices, axis=0).max()
        unit = (mesh.vertices - center) / size  # a unit-sized copy: squared distances stay in range at any scale
        face, weights, _ = closest_on_triangles((p - center) / size, unit, mesh.faces)
        return cls(mesh, face, weights)

    def __len__(self) -> int:
        return len(self.face)

    def __getitem__(self, index: ArrayLike | slice) -> SurfacePoints:
        if not isinstance(index, slice):
            index = np.atleast_1d(np.asarray(index))
            index = index if index.size else np.empty(0, dtype=np.int64)
        return SurfacePoints(self.mesh, self.face[index], self.barycentric[index])

    def __repr__(self) -> str:
        return f"SurfacePoints({len(self)} on {self.mesh!r})"

    @property
    def positions(self) -> Floats:
        """Positions in space, shape (p, 3), in the unit of the mesh."""
        return self.interpolate(self.mesh.vertices)

    def interpolate(self, values: ArrayLike) -> Floats:
        """Values per vertex, linearly interpolated at the points: :math:`b_1 u_i + b_2 u_j + b_3 u_k`.

        Parameters
        ----------
        values : array_like of shape (n,) or (n, c)
            One row per vertex, of any unit.

        Returns
        -------
        array of shape (p,) or (p, c)
            One row per point.

        Raises
        ------
        MeshError
            E108 when there is not one row per vertex.
        """
        values = np.asarray(values)
        if values.ndim == 0 or len(values) != self.mesh.n_vertices:
            raise BadShape(f"values must have one row per vertex, {self.mesh.n_vertices}, not shape {values.shape}")
        corners = values[self.mesh.faces[self.face]]
        return combination(self.barycentric, corners)

    def nearest_vertices(self) -> Integers:
        """The corner with the largest weight, shape (p,)."""
        return self.mesh.faces[self.face, self.barycentric.argmax(axis=1)]


@memoized
def _corner_of_vertex(mesh: Mesh) -> Integers:
    """For each vertex one corner index 3 * face + slot, -1 where it is on no face."""
    corner = np.full(mesh.n_vertices, -1, dtype=np.int64)
    corner[mesh.faces.ravel()[::-1]] = np.arange(3 * mesh.n_faces - 1, -1, -1)
    return corner


def mixed(choice: Bools, points: SurfacePoints, others: SurfacePoints) -> SurfacePoints:
    """Of two sets of points (p,) on one mesh, those of the first where `choice` (p,) is True, else of the second."""
    face = np.where(choice, points.face, others.face)
    return SurfacePoints(points.mesh, face, np.where(choice[:, None], points.barycentric, others.barycentric))


def joined(points: SurfacePoints, others: SurfacePoints) -> SurfacePoints:
    """Both sets of points on one mesh, one after the other."""
    face = np.concatenate([points.face, others.face])
    return SurfacePoints(points.mesh, face, np.concatenate([points.barycentric, others.barycentric]))
