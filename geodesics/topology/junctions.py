"""T-junctions: vertices of open edges that lie on another open edge, along which they run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import memoized
from geodesics.mesh import Mesh
from geodesics.topology.edges import edge_keys, edges

# How far off an edge a vertex may lie, in units of the extent of the mesh: a derivation. With six significant digits,
# the fewest that programs write, the vertex and both ends are off by up to half a unit of the sixth digit along each
# axis, together sqrt(3) units, which are 1e-5 of the extent of a mesh beside the origin at the most. Single precision
# is off by a hundredth of that. Nor may it be farther off than this share of the edge and of the shortest open edge at
# the vertex, nor as near to an end of the edge: two sides of a gap can be shifted along an edge. Set by hand.
ROUNDING = 1e-5
SHARE_OF_EDGE = 0.01


@dataclass(frozen=True, eq=False)
class Junctions:
    """Vertices that lie on open edges, in the order in which the face of the edge passes them.

    `side` (k,) is the open edge as a flat index 3 * face + corner, ascending; `vertex` (k,) lies on it, at the share
    `along` (k,) of its length.
    """

    side: Integers
    vertex: Integers
    along: Floats

    def __len__(self) -> int:
        return len(self.side)

    def __getitem__(self, rows: Bools | Integers) -> Junctions:
        return Junctions(self.side[rows], self.vertex[rows], self.along[rows])


@memoized
def junctions(mesh: Mesh) -> Junctions:
    """The T-junctions of a mesh: where two open edges run along each other and a vertex of the one lies on the other.

    Edges that merely cross or touch are none, and what lies farther off than rounding is a gap.
    """
    table = edges(mesh)
    side = np.flatnonzero(np.isin(table.of_side.ravel(), np.flatnonzero(table.n_faces == 1)))
    if len(side) == 0:
        return Junctions(side, side, np.empty(0))
    found = _on_edges(mesh, side)
    return found[_along_each_other(mesh, side, found)] if len(found) else found


def _ends(mesh: Mesh, side: Integers) -> tuple[Integers, Integers, Integers]:
    """The vertices from which and to which sides run, and the third corners."""
    flat, first = mesh.faces.ravel(), side - side % 3
    return flat[side], flat[first + (side + 1) % 3], flat[first + (side + 2) % 3]


def _on_edges(mesh: Mesh, side: Integers) -> Junctions:
    """Ends of the open edges (sides of faces) that lie on another of them."""
    a, b, c = _ends(mesh, side)
    start, run = mesh.vertices[a], mesh.vertices[b] - mesh.vertices[a]
    length = np.linalg.norm(run, axis=1)
    extent = float(np.ptp(mesh.vertices[np.unique(mesh.faces)], axis=0).max())
    shortest = np.full(mesh.n_vertices, np.inf)
    np.minimum.at(shortest, np.concatenate([a, b]), np.concatenate([length, length]))
    reach = np.minimum(ROUNDING * extent, SHARE_OF_EDGE * length)
    edge, vertex = _near(mesh, start, run, reach, np.flatnonzero(shortest < np.inf))
    other = (vertex != a[edge]) & (vertex != b[edge]) & (vertex != c[edge])
    edge, vertex = edge[other], vertex[other]
    away = mesh.vertices[vertex] - start[edge]
    along = np.einsum("ij,ij->i", away, run[edge]) / np.maximum(length[edge] ** 2, np.finfo(float).tiny)
    off = np.linalg.norm(away - along[:, None] * run[edge], axis=1)
    small = SHARE_OF_EDGE * np.minimum(length[edge], shortest[vertex])
    inside = (np.minimum(along, 1 - along) * length[edge] > small) & (off <= np.minimum(reach[edge], small))
    edge, vertex, along = edge[inside], vertex[inside], along[inside]
    order = np.lexsort((vertex, along, side[edge]))
    return Junctions(side[edge[order]], vertex[order], along[order])


def _near(mesh: Mesh, start: Floats, run: Floats, reach: Floats, ends: Integers) -> tuple[Integers, Integers]:
    """Pairs of an edge and one of the vertices `ends` in a ball around a piece of it, each once.

    Pieces are as long as the mean edge at the most, so that there are at most twice as many as edges, however long one
    of them is. The balls hold all that is within reach of the edge.
    """
    length = np.linalg.norm(run, axis=1)
    pieces = np.maximum(np.ceil(length / max(float(length.mean()), np.finfo(float).tiny)), 1).astype(np.int64)
    edge = np.repeat(np.arange(len(length)), pieces)
    number = np.arange(len(edge)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    center = start[edge] + run[edge] * ((number + 0.5) / pieces[edge])[:, None]
    radius = 0.5 * length[edge] / pieces[edge] + reach[edge]
    near = cKDTree(mesh.vertices[ends]).query_ball_point(center, radius, return_sorted=False)
    counts = np.fromiter(map(len, near), dtype=np.int64, count=len(near))
    hit = np.fromiter((one for row in near for one in row), dtype=np.int64, count=int(counts.sum()))
    key = np.unique(np.repeat(edge, counts) * len(ends) + hit)
    return key // len(ends), ends[key % len(ends)]


def _along_each_other(mesh: Mesh, side: Integers, found: Junctions) -> Bools:
    """Which of the vertices found on edges end a piece that another open edge, or a piece of one, has as well."""
    a, b, _ = _ends(mesh, side)
    place = np.searchsorted(side, found.side)  # the row of the edge of each
    counts = np.bincount(place, minlength=len(side))
    chain = np.insert(found.vertex, np.cumsum(counts) - counts, a)  # each edge: where it starts, and what lies on it
    after = np.append(chain[1:], 0)
    after[np.cumsum(counts + 1) - 1] = b
    _, name, times = np.unique(edge_keys(chain, after, mesh.n_vertices), return_inverse=True, return_counts=True)
    shared = times[name.reshape(-1)] > 1
    piece = np.arange(len(found)) + place + 1  # the piece that starts at the vertex
    return np.asarray(shared[piece] | shared[piece - 1])
