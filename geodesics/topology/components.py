"""How faces are connected: boundary and connected components."""

from __future__ import annotations

import numpy as np

from geodesics import intrinsic
from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import memoized
from geodesics.mesh import Mesh
from geodesics.topology.edges import components, edge_ends, edge_keys, proper_faces


@memoized
def boundary_vertices(mesh: Mesh) -> Bools:
    """Vertices on an edge of only one face.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.

    Returns
    -------
    bool array of shape (n,)
        True on the boundary.
    """
    faces = mesh.faces[proper_faces(mesh.faces)]
    keys, count = np.unique(edge_keys(faces, np.roll(faces, -1, axis=1), mesh.n_vertices), return_counts=True)
    mask = np.zeros(mesh.n_vertices, dtype=bool)
    mask[edge_ends(keys[count == 1], mesh.n_vertices)] = True
    return mask


@memoized
def vertex_components(mesh: Mesh) -> Integers:
    """The connected component of every vertex.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.

    Returns
    -------
    int array of shape (n,)
        Labels from 0; -1 where a vertex is on no face.
    """
    n, faces = mesh.n_vertices, mesh.faces
    label = components(faces[:, [0, 0]].ravel(), faces[:, [1, 2]].ravel(), n)
    used = np.zeros(n, dtype=bool)
    used[faces] = True
    compact = np.full(n, -1, dtype=np.int64)
    compact[used] = np.unique(label[used], return_inverse=True)[1]
    return compact


def component_areas(mesh: Mesh) -> Floats:
    """Area of every component (c,), in the order of their labels, in squared units of the coordinates."""
    return _summed(mesh, intrinsic.areas(intrinsic.squared_lengths(mesh.vertices, mesh.faces)))


def largest_component(mesh: Mesh, weights: Floats | None = None) -> Bools:
    """Faces (m,) of the largest component: by area, or by the sum of other weights (m,); the first of equal ones."""
    size = component_areas(mesh) if weights is None else _summed(mesh, weights)
    return np.asarray(vertex_components(mesh)[mesh.faces[:, 0]] == size.argmax())


def _summed(mesh: Mesh, weights: Floats) -> Floats:
    """Sum of weights (m,) over the faces of every component (c,)."""
    return np.bincount(vertex_components(mesh)[mesh.faces[:, 0]], weights=weights).astype(np.float64, copy=False)
