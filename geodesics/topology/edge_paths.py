"""Shortest paths along the edges of a mesh: as long as geodesics or longer, and cheap."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra

from geodesics.arrays import Floats, Integers
from geodesics.caching import memoized
from geodesics.mesh import Mesh
from geodesics.topology.edges import edge_ends, edge_keys


def edge_distances(mesh: Mesh, sources: Integers, limit: float = np.inf) -> Floats:
    """Length of the shortest path along edges from each source (k,) to every vertex, (k, n).

    +inf where there is none, or where it is longer than `limit`.
    """
    return np.atleast_2d(dijkstra(_edge_lengths(mesh), directed=False, indices=sources, limit=limit))


def distances_to_nearest(mesh: Mesh, sources: Integers, limit: float = np.inf) -> Floats:
    """The least of `edge_distances`, of all sources, to every vertex (n,)."""
    found = dijkstra(_edge_lengths(mesh), directed=False, indices=sources, min_only=True, limit=limit)
    return np.asarray(found, dtype=np.float64)


@memoized
def _edge_lengths(mesh: Mesh) -> sp.csr_matrix:
    i, j = mesh.faces.ravel(), mesh.faces[:, [1, 2, 0]].ravel()
    length = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1)
    n = mesh.n_vertices
    keys, first = np.unique(edge_keys(i, j, n), return_index=True)
    return sp.coo_matrix((length[first], edge_ends(keys, n).T), shape=(n, n)).tocsr()
