"""Edges of a mesh, whatever its defects: which faces share them, and in which direction they run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from geodesics.arrays import Bools, Integers
from geodesics.caching import memoized
from geodesics.mesh import Mesh

MOST_CODED = 2_000_000  # vertices of which three make one whole number of 64 bits


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges without direction. Sides of faces with a repeated corner are left out (edge -1).

    `ends` (e, 2) vertices in ascending order, `of_side` (m, 3) the edge from corner k to corner k + 1 of each face,
    `forward` (m, 3) whether the face runs along it in ascending order, `n_faces` (e,) how many faces share it.
    """

    ends: Integers
    of_side: Integers
    forward: Bools
    n_faces: Integers

    def pairs(self) -> tuple[Integers, Integers]:
        """For each edge of exactly two faces its two sides, as flat indices 3 * face + k into `of_side`."""
        side = np.flatnonzero(self.of_side.ravel() >= 0)
        first, second = twice_given(self.of_side.ravel()[side])
        return side[first], side[second]


def edge_keys(start: Integers, end: Integers, n: int) -> Integers:
    """One number for each undirected edge between vertices below n: equal for both directions, ordered as its ends."""
    return np.minimum(start, end) * n + np.maximum(start, end)


def edge_ends(keys: Integers, n: int) -> Integers:
    """The two vertices (..., 2) of each of the `edge_keys`, in ascending order."""
    return np.stack([keys // n, keys % n], axis=-1)


def twice_given(keys: Integers) -> tuple[Integers, Integers]:
    """Indices (k,) of the first and of the second of the keys that occur exactly twice, by ascending key."""
    order = np.argsort(keys, kind="stable")
    first, count = np.unique(keys[order], return_index=True, return_counts=True)[1:]
    two = first[count == 2]
    return order[two], order[two + 1]


@memoized
def edges(mesh: Mesh) -> Edges:
    """The edge table of a mesh."""
    a, b = mesh.faces, np.roll(mesh.faces, -1, axis=1)
    sound = ~degenerate_faces(mesh)
    key = edge_keys(a, b, mesh.n_vertices)
    unique, inverse, count = np.unique(key[sound], return_inverse=True, return_counts=True)
    of_side = np.full(mesh.faces.shape, -1, dtype=np.int64)
    of_side[sound] = inverse.reshape(-1, 3)
    return Edges(edge_ends(unique, mesh.n_vertices), of_side, a < b, count)


def degenerate_faces(mesh: Mesh) -> Bools:
    """Faces that name one vertex more than once, shape (m,)."""
    a, b, c = mesh.faces.T
    return np.asarray((a == b) | (b == c) | (c == a))


def face_components(mesh: Mesh) -> Integers:
    """Component of every face, shape (m,), where faces that share an edge of exactly two faces are connected."""
    first, second = edges(mesh).pairs()
    return components(first // 3, second // 3, mesh.n_faces)


@memoized
def corner_fans(mesh: Mesh) -> Integers:
    """Which fan around its vertex each corner belongs to, shape (m, 3), numbered over the whole mesh.

    Corners of one vertex are in one fan when their faces share an edge at that vertex; a vertex of several fans is not
    manifold.
    """
    table = edges(mesh)
    side = np.flatnonzero(table.of_side.ravel() >= 0)
    order = side[np.argsort(table.of_side.ravel()[side], kind="stable")]
    meets = table.of_side.ravel()[order][1:] == table.of_side.ravel()[order][:-1]
    s, t = order[:-1][meets], order[1:][meets]
    start = np.arange(3 * mesh.n_faces)
    end = (start // 3) * 3 + (start + 1) % 3
    same = table.forward.ravel()[s] == table.forward.ravel()[t]
    left = np.concatenate([start[s], end[s]])
    right = np.concatenate([np.where(same, start[t], end[t]), np.where(same, end[t], start[t])])
    return components(left, right, 3 * mesh.n_faces).reshape(-1, 3)


def components(left: Integers, right: Integers, n: int) -> Integers:
    """Connected components of the graph on 0 .. n - 1 with edges left - right: labels, shape (n,)."""
    graph = sp.coo_matrix((np.ones(len(left), dtype=np.int8), (left, right)), shape=(n, n))
    return np.asarray(sp.csgraph.connected_components(graph, directed=False)[1], dtype=np.int64)


def proper_faces(faces: Integers) -> Integers:
    """Rows of faces (m, 3) with three different vertices, each oriented triple once; ascending."""
    a, b, c = faces.T
    proper = np.flatnonzero((a != b) & (b != c) & (c != a))
    first = faces[proper].argmin(axis=1)
    turned = faces[proper[:, None], (first[:, None] + np.arange(3)) % 3]
    n = int(faces.max(initial=0)) + 1
    if n > MOST_CODED:
        return proper[np.sort(np.unique(turned, axis=0, return_index=True)[1])]
    return proper[np.sort(np.unique((turned[:, 0] * n + turned[:, 1]) * n + turned[:, 2], return_index=True)[1])]
