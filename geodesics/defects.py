"""Where a mesh has defects that a face or a vertex shows by itself."""

from __future__ import annotations

import numpy as np

from geodesics._validation import is_flat
from geodesics.arrays import Bools
from geodesics.mesh import Mesh
from geodesics.topology.edges import degenerate_faces


def repeated_faces(mesh: Mesh) -> Bools:
    """Faces of the same three vertices, in any order, as an earlier face.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of m faces.

    Returns
    -------
    bool array of shape (m,)
        True for every copy but the first.
    """
    _, first = np.unique(np.sort(mesh.faces, axis=1), axis=0, return_index=True)
    repeated = np.ones(mesh.n_faces, dtype=bool)
    repeated[first] = False
    return repeated


def flat_faces(mesh: Mesh) -> Bools:
    """Faces of three different vertices whose area is no more than the rounding of the coordinates.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of m faces.

    Returns
    -------
    bool array of shape (m,)
        True for such faces.
    """
    return np.asarray(is_flat(mesh.vertices, mesh.faces) & ~degenerate_faces(mesh))


def unreferenced_vertices(mesh: Mesh) -> Bools:
    """Vertices on no face.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.

    Returns
    -------
    bool array of shape (n,)
        True for such vertices.
    """
    unused = np.ones(mesh.n_vertices, dtype=bool)
    unused[mesh.faces] = False
    return unused
