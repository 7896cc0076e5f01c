"""How the faces of a mesh hang together: boundary and connected components."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Bools, Integers
from geodesics.caching import memoized
from geodesics.mesh import Mesh
from geodesics.topology.edges import components, proper_faces


@memoized
def boundary_vertices(mesh: Mesh) -> Bools:
    """True where a vertex touches an edge with only one face, shape (n,)."""
    faces = mesh.faces[proper_faces(mesh.faces)]
    edges = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    _, first, count = np.unique(edges[:, 0] * mesh.n_vertices + edges[:, 1], return_index=True, return_counts=True)
    mask = np.zeros(mesh.n_vertices, dtype=bool)
    mask[edges[first[count == 1]]] = True
    return mask


@memoized
def vertex_components(mesh: Mesh) -> Integers:
    """Component label of every vertex, shape (n,), numbered from 0; -1 where a vertex is on no face."""
    n, faces = mesh.n_vertices, mesh.faces
    label = components(faces[:, [0, 0]].ravel(), faces[:, [1, 2]].ravel(), n)
    used = np.zeros(n, dtype=bool)
    used[faces] = True
    compact = np.full(n, -1, dtype=np.int64)
    compact[used] = np.unique(label[used], return_inverse=True)[1]
    return compact
