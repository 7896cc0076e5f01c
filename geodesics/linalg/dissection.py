"""An order of elimination for the sparse matrices of large surfaces: nested dissection."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from geodesics.arrays import Bools, Floats, Integers

_PIVOTS, _SMOOTHING = 6, 10
_LEAF = 16  # parts this small are not cut


def nested_dissection(matrix: sp.csr_matrix) -> Integers:
    """The rows of a symmetric matrix (n, n) in an order that makes few new entries when it is factorised (George 1973).

    Each part is halved, its two sides come first, and last the rows that keep them apart. On a surface the separators
    are level sets of distances counted in edges: minimum degree orders fill less below about 100,000 rows, but take
    far longer to factorise above.
    """
    matrix = matrix.tocsr()
    graph = sp.csr_matrix((np.ones(matrix.nnz), matrix.indices, matrix.indptr), shape=matrix.shape)
    places = hop_distances(graph, _PIVOTS)
    average = sp.diags(1 / np.maximum(np.diff(graph.indptr), 1)) @ graph
    for _ in range(_SMOOTHING):  # level sets of whole numbers are ragged
        places = average @ places
    order, side = np.empty(len(places), dtype=np.int64), np.zeros(len(places), dtype=np.int64)
    parts, label = [(np.arange(len(places)), len(places))], 0
    while parts:
        rows, end = parts.pop()
        if len(rows) <= _LEAF:
            order[end - len(rows) : end] = rows
            continue
        low = _half(places[rows])
        label += 1
        side[rows], side[rows[low]] = label, -label
        first = rows[low]
        border = _has_neighbour(matrix, first, side, label)
        start = end - int(border.sum())
        order[start:end] = first[border]
        parts += [(rows[~low], start), (first[~border], start - int((~low).sum()))]
    return order


def hop_distances(graph: sp.csr_matrix, count: int) -> Floats:
    """Distances in edges (n, count) from rows far from one another; n from rows that are not linked."""
    n = graph.shape[0]
    places, pivot = np.empty((n, count)), 0
    for k in range(count):
        places[:, k] = sp.csgraph.dijkstra(graph, indices=pivot, unweighted=True)
        places[np.isinf(places[:, k]), k] = n
        pivot = int(places[:, : k + 1].min(axis=1).argmax())
    return places


def _half(places: Floats) -> Bools:
    """The half (p,) of the places (p, d) before the middle along the direction in which they reach farthest."""
    spread = places - places.mean(axis=0)
    along = spread @ np.linalg.eigh(spread.T @ spread)[1][:, -1]
    low = np.zeros(len(places), dtype=bool)
    low[np.argpartition(along, len(along) // 2)[: len(along) // 2]] = True
    return low


def _has_neighbour(matrix: sp.csr_matrix, rows: Integers, side: Integers, label: int) -> Bools:
    """Which of the rows (p,) have an entry in a column on the given side."""
    start = matrix.indptr[rows]
    count = matrix.indptr[rows + 1] - start
    end = np.cumsum(count)
    entry = np.arange(end[-1]) + np.repeat(start - end + count, count)
    found = np.zeros(len(rows), dtype=bool)
    found[np.repeat(np.arange(len(rows)), count)[side[matrix.indices[entry]] == label]] = True
    return found
