"""Farthest points, and the cells nearest to each of them, in any distance."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from geodesics._validation import as_indices
from geodesics.arguments import is_whole
from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import memoized
from geodesics.distance import Distance, as_distance
from geodesics.errors import BadArgument
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from geodesics.topology.components import vertex_components

Closer = Callable[[int, Floats], tuple[Integers, Floats]]
FEW = 4  # vertices; smaller components get no sample of their own. A convention: the smallest closed surface has four


@runtime_checkable
class Spreading(Protocol):
    """A distance that finds the vertices closer to a new sample than to all others without measuring the rest."""

    def spreader(self) -> Closer:
        """A function (vertex, nearest (n,)) -> the vertices closer to this one than `nearest`, and their distances."""


class Cells(NamedTuple):
    """Samples (count,), and for every vertex (n,) the index of the nearest one (-1 if unreachable) and its distance."""

    samples: Integers
    nearest: Integers
    distance: Floats


def farthest_point_sampling(distance: Distance, count: int, first: int | None = None) -> Integers:
    """Vertices of which each is the farthest from those before it (sec. 5, Fig. 6).

    Every component of at least four vertices gets a sample as soon as those before it leave none nearer; an isolated
    vertex is never chosen.

    Parameters
    ----------
    distance : Distance
        What "farthest" means; its mesh has n vertices.
    count : int
        Number k of samples.
    first : int, optional
        The vertex to begin with; else the one farthest from the centroid.

    Returns
    -------
    int array of shape (k,)
        Vertices.

    Raises
    ------
    ValueError
        When there are fewer vertices that can be chosen, or `first` is none of these.

    References
    ----------
    Gonzalez: Clustering to minimize the maximum intercluster distance (1985).

    See Also
    --------
    voronoi_cells : The vertices nearest to each sample.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> samples = geodesics.farthest_point_sampling(geodesics.GeodesicDistance(sphere), 5)
    >>> len(set(samples.tolist()))
    5
    """
    return farthest_point_cells(distance, count, first).samples


def farthest_point_cells(distance: Distance, count: int, first: int | None = None, begun: Cells | None = None) -> Cells:
    """Farthest-point sampling with the Voronoi cells it leaves behind; fewer that were `begun` so are gone on from.

    With a geodesic distance each front stops where it meets a smaller distance: O(n log n) for all samples together.
    """
    mesh = as_distance(distance).mesh
    eligible = _eligible(mesh).copy()
    if not is_whole(count) or not 1 <= count <= eligible.sum():
        raise BadArgument(f"count must be 1 to {eligible.sum()}, not {count!r:.40}")
    if first is not None and not (is_whole(first) and 0 <= first < mesh.n_vertices and eligible[first]):
        raise BadArgument(f"first must be a vertex on the surface, not {first!r:.40}")
    closer, samples = _spreader(distance), np.empty(count, dtype=np.int64)
    nearest, cell = np.full(mesh.n_vertices, np.inf), np.full(mesh.n_vertices, -1, dtype=np.int64)
    done = 0 if begun is None else len(begun.samples)
    if begun is None:
        samples[0] = _outermost(mesh, eligible) if first is None else first
    else:
        samples[:done], nearest, cell = begun.samples, begun.distance.copy(), begun.nearest.copy()
        eligible[begun.samples] = False
    for i in range(done, count):
        if i > 0:
            samples[i] = np.where(eligible, nearest, -1.0).argmax()
        eligible[samples[i]] = False
        where, values = closer(int(samples[i]), nearest)
        nearest[where], cell[where] = values, i
    return Cells(samples, cell, nearest)


def voronoi_cells(distance: Distance, samples: ArrayLike) -> Integers:
    """The nearest sample of every vertex: the cells of Fig. 6.

    Parameters
    ----------
    distance : Distance
        What "nearest" means; its mesh has n vertices.
    samples : array_like of shape (k,)
        Vertices.

    Returns
    -------
    int array of shape (n,)
        Index into `samples`, or -1 where no sample can be reached.

    Raises
    ------
    MeshError
        E105 to E107 for samples that are no vertices.

    See Also
    --------
    farthest_point_sampling : Samples that are evenly spread.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> distance = geodesics.GeodesicDistance(sphere)
    >>> samples = geodesics.farthest_point_sampling(distance, 3)
    >>> cells = geodesics.voronoi_cells(distance, samples)  # for every vertex the number of its sample
    >>> cells[samples].tolist()
    [0, 1, 2]
    """
    n, closer = as_distance(distance).mesh.n_vertices, _spreader(distance)
    nearest, cell = np.full(n, np.inf), np.full(n, -1, dtype=np.int64)
    for i, vertex in enumerate(as_indices(samples, n, "sample", "vertices").reshape(-1)):
        where, values = closer(int(vertex), nearest)
        nearest[where], cell[where] = values, i
    return cell


def _spreader(distance: Distance) -> Closer:
    """The distance's own way to find closer vertices, or a whole field a sample."""
    if isinstance(distance, Spreading):
        return distance.spreader()

    def closer(vertex: int, nearest: Floats) -> tuple[Integers, Floats]:
        field = distance.field(SurfacePoints.at_vertices(distance.mesh, [vertex]))[0]
        where = np.flatnonzero(field < nearest)
        return where, field[where]

    return closer


@memoized
def _eligible(mesh: Mesh) -> Bools:
    """Vertices on faces (n,), without components of fewer than `FEW` vertices unless there are only such."""
    label = vertex_components(mesh)
    used = label >= 0
    large = used & (np.bincount(label[used])[label] >= FEW)
    return large if large.any() else used


def _outermost(mesh: Mesh, eligible: Bools) -> int:
    """The eligible vertex farthest from the centroid of all of them."""
    offset = mesh.vertices - mesh.vertices[eligible].mean(axis=0)
    return int(np.where(eligible, (offset**2).sum(axis=1), -1.0).argmax())
