"""A triangle mesh: checked once when it is made, and never changed afterwards."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from geodesics import intrinsic
from geodesics._duck import arrays_of
from geodesics._validation import as_faces, as_indices, as_vertices, check_area
from geodesics.arrays import Floats, Integers
from geodesics.errors import BadShape

F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh: checked when it is made, and never changed afterwards.

    Parameters
    ----------
    vertices : array_like of shape (n, 3), or mesh object
        Positions, in any unit of length; or a mesh of trimesh, pyvista, meshio or Open3D, and no `faces`.
    faces : array_like of shape (m, 3)
        Three vertices per triangle, counted from 0.

    Attributes
    ----------
    vertices : float64 array of shape (n, 3)
        A read-only copy of the positions.
    faces : int64 array of shape (m, 3)
        A read-only copy of the triangles.

    Raises
    ------
    MeshError
        Naming the first offending vertex or face: E101 not finite, E102 too large or too small for float64, E103 no
        vertices, E104 no faces, E105 no such vertex, E106 not a whole number, E107 not real numbers, E108 wrong shape,
        E109 larger polygons, E114 no face has an area.

    See Also
    --------
    read_mesh : A mesh from a file.
    triangulate : Triangles from larger polygons.
    geodesics.check.check : What is unusual about a mesh.

    Examples
    --------
    >>> import geodesics
    >>> square = geodesics.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> square.n_vertices, square.n_faces, square.area
    (4, 2, 1.0)
    """

    vertices: Floats
    faces: Integers

    def __init__(self, vertices: ArrayLike | Any, faces: ArrayLike | None = None) -> None:
        if faces is None and (arrays := arrays_of(vertices)) is not None:
            vertices, faces = arrays
        v = as_vertices(vertices)
        f = as_faces(faces, len(v))
        check_area(v, f)
        v.setflags(write=False)
        f.setflags(write=False)
        object.__setattr__(self, "vertices", v)
        object.__setattr__(self, "faces", f)

    @classmethod
    def from_object(cls, mesh: Any) -> Mesh:
        """A mesh from a mesh object of another library.

        Parameters
        ----------
        mesh : mesh object
            Of trimesh, pyvista, meshio or Open3D. A `Mesh` is returned as it is.

        Returns
        -------
        Mesh
            The same vertices and triangles.

        Raises
        ------
        TypeError
            For anything else.
        MeshError
            Where the arrays of the object do not describe a triangle mesh.
        """
        if isinstance(mesh, cls):
            return mesh
        arrays = arrays_of(mesh)
        if arrays is None:
            raise TypeError(
                f"a mesh is expected, not {type(mesh).__name__}; for example geodesics.Mesh(vertices, faces), "
                "geodesics.read_mesh(path), or a mesh object of trimesh, pyvista or meshio"
            )
        return cls(*arrays)

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


def of_a_mesh(function: F) -> F:
    """Have a function of a mesh take mesh objects of other libraries too, and refuse anything else in one sentence."""

    @functools.wraps(function)
    def wrapper(mesh: Any, *arguments: Any, **options: Any) -> Any:
        return function(Mesh.from_object(mesh), *arguments, **options)

    return wrapper  # type: ignore[return-value]


def triangulate(faces: ArrayLike) -> Integers:
    """Split polygons about their first corner into triangles, in order; no vertex is added.

    Parameters
    ----------
    faces : array_like of shape (m, k), k >= 3
        Vertices of each polygon, counted from 0.

    Returns
    -------
    int64 array of shape (m (k - 2), 3)
        The triangles of the first polygon, then those of the second, and so on.

    Raises
    ------
    MeshError
        E108 when the array is not (m, k) with k >= 3; E105 - E107 when it does not hold whole numbers from 0.

    Examples
    --------
    >>> import geodesics
    >>> geodesics.triangulate([[0, 1, 2, 3]]).tolist()  # a quadrangle
    [[0, 1, 2], [0, 2, 3]]
    """
    f = as_indices(faces, 2**63 - 1, "face", "possible vertices")
    if f.ndim != 2 or f.shape[1] < 3:
        raise BadShape(f"faces must have shape (m, k) with k >= 3, not {f.shape}")
    slots = [(0, i, i + 1) for i in range(1, f.shape[1] - 1)]
    return np.ascontiguousarray(f[:, slots].reshape(-1, 3))
