"""Farthest points, and the cells nearest to each of them, in any distance."""

from __future__ import annotations

from typing import Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray
from scipy.sparse.csgraph import connected_components

from geodesics._memo import memoized
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

FEW = 4  # components of fewer vertices get no sample of their own


class Distance(Protocol):
    """Anything that measures distances from points to all vertices of one mesh."""

    @property
    def mesh(self) -> Mesh:
        """The mesh."""

    def field(self, points: SurfacePoints) -> Floats:
        """Distances (p, n) from each of p points to every vertex; +inf where unreachable."""


def farthest_point_sampling(distance: Distance, count: int, first: int | None = None) -> Integers:
    """`count` vertices (count,), each the farthest from those before it (Gonzalez 1985; sec. 5, Fig. 6).

    Starts at vertex `first`, else at the vertex farthest from the centroid. Every component of at least four vertices
    gets its sample; an isolated vertex is never chosen. Raises `ValueError` when `count` is more than there are.
    """
    mesh = distance.mesh
    eligible = _eligible(mesh)
    if not 1 <= count <= eligible.sum():
        raise ValueError(f"count must be 1 to {eligible.sum()}, not {count}")
    samples = np.empty(count, dtype=np.int64)
    samples[0] = _outermost(mesh, eligible) if first is None else first
    nearest = np.where(eligible, np.inf, -1.0)
    for i in range(count):
        if i > 0:
            samples[i] = nearest.argmax()
        field = distance.field(SurfacePoints.at_vertices(mesh, samples[i : i + 1]))[0]
        nearest = np.minimum(nearest, field)
        nearest[samples[: i + 1]] = -1.0
    return samples


def voronoi_cells(distance: Distance, samples: ArrayLike) -> Integers:
    """The index into `samples` (count,) of the nearest one for every vertex (n,), or -1: the cells of Fig. 6."""
    mesh = distance.mesh
    samples = np.asarray(samples, dtype=np.int64).reshape(-1)
    nearest, cell = np.full(mesh.n_vertices, np.inf), np.full(mesh.n_vertices, -1, dtype=np.int64)
    for i in range(len(samples)):
        field = distance.field(SurfacePoints.at_vertices(mesh, samples[i : i + 1]))[0]
        closer = field < nearest
        nearest[closer], cell[closer] = field[closer], i
    return cell


@memoized
def _eligible(mesh: Mesh) -> NDArray[np.bool_]:
    """Vertices on faces (n,), without components of fewer than `FEW` vertices unless there are only such."""
    used = np.zeros(mesh.n_vertices, dtype=bool)
    used[mesh.faces] = True
    i, j = mesh.faces[:, [0, 1, 2]].ravel(), mesh.faces[:, [1, 2, 0]].ravel()
    graph = sp.coo_matrix((np.ones(len(i)), (i, j)), shape=(mesh.n_vertices,) * 2)
    label = connected_components(graph, directed=False)[1]
    large = used & (np.bincount(label)[label] >= FEW)
    return large if large.any() else used


def _outermost(mesh: Mesh, eligible: NDArray[np.bool_]) -> int:
    """The eligible vertex farthest from the centroid of all of them."""
    offset = mesh.vertices - mesh.vertices[eligible].mean(axis=0)
    return int(np.where(eligible, (offset**2).sum(axis=1), -1.0).argmax())
