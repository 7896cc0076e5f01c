"""Factors L D L^T of sparse symmetric positive definite matrices: the pattern once, the numbers as often as needed.

The up-looking method: row k of L is the solution of a triangular system, whose pattern is what the elimination tree
reaches from row k of the matrix (Davis: Algorithm 849, a concise sparse Cholesky factorization package, 2005).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics._kernels.jit import njit, uncounted
from geodesics.arrays import Floats, Integers

Indices = NDArray[np.int32]


@njit
def elimination(start: Indices, row: Indices) -> tuple[Indices, Integers]:
    """The elimination tree, as the parent (n,) of each column or -1, and where the columns of L start (n + 1,).

    Column k of the symmetric matrix has its entries in the rows `row[start[k]:start[k + 1]]`.
    """
    n = len(start) - 1
    parent, seen, count = np.full(n, -1, np.int32), np.empty(n, np.int32), np.zeros(n + 1, np.int64)
    for k in range(n):
        seen[k] = k
        for p in range(start[k], start[k + 1]):
            i = row[p]
            while i < k and seen[i] != k:
                if parent[i] == -1:
                    parent[i] = k
                count[i + 1] += 1
                seen[i] = k
                i = parent[i]
    return parent, np.cumsum(count)


@njit
def factors(
    start: Indices, row: Indices, value: Floats, diagonal: Floats, parent: Indices, first: Integers
) -> tuple[Indices, Floats, Floats]:
    """Rows and values of the entries of L below its diagonal of ones, column by column, and D (n,).

    `diagonal` (n,) is added to what the matrix has there. Of a matrix that is not positive definite D is not positive
    from some row on, and 0 after that.
    """
    n = len(parent)
    found, entry, pivot = np.empty(first[n], np.int32), np.empty(first[n]), np.zeros(n)
    work, path, seen = np.zeros(n), np.empty(n, np.int32), np.full(n, -1, np.int32)
    end = first[:n].copy()
    for k in range(n):
        top, rest = n, diagonal[k]
        seen[k] = k
        for p in range(start[k], start[k + 1]):
            i = row[p]
            if i == k:
                rest += value[p]
            elif i < k:
                work[i] += value[p]
                length = 0
                while seen[i] != k:
                    path[length] = i
                    length += 1
                    seen[i] = k
                    i = parent[i]
                while length > 0:
                    top -= 1
                    length -= 1
                    path[top] = path[length]
        for q in range(top, n):
            i = path[q]
            y = work[i]
            work[i] = 0.0
            for p in range(first[i], end[i]):
                work[found[p]] -= entry[p] * y
            scaled = y / pivot[i]
            rest -= scaled * y
            found[end[i]], entry[end[i]] = k, scaled
            end[i] += 1
        pivot[k] = rest
        if not rest > 0.0:
            break
    return found, entry, pivot


@uncounted
def solve_three(first: Integers, found: Indices, entry: Floats, pivot: Floats, x: Floats) -> None:
    """Replace x (n, 3) by the solution of L D L^T y = x."""
    for j in range(len(pivot)):
        a, b, c = x[j, 0], x[j, 1], x[j, 2]
        for p in range(first[j], first[j + 1]):
            i, v = found[p], entry[p]
            x[i, 0] -= v * a
            x[i, 1] -= v * b
            x[i, 2] -= v * c
    for j in range(len(pivot) - 1, -1, -1):
        a, b, c = x[j, 0] / pivot[j], x[j, 1] / pivot[j], x[j, 2] / pivot[j]
        for p in range(first[j], first[j + 1]):
            i, v = found[p], entry[p]
            a -= v * x[i, 0]
            b -= v * x[i, 1]
            c -= v * x[i, 2]
        x[j, 0], x[j, 1], x[j, 2] = a, b, c


@uncounted
def solve_one(first: Integers, found: Indices, entry: Floats, pivot: Floats, x: Floats) -> None:
    """Replace x (n,) by the solution of L D L^T y = x."""
    for j in range(len(pivot)):
        a = x[j]
        for p in range(first[j], first[j + 1]):
            x[found[p]] -= entry[p] * a
    for j in range(len(pivot) - 1, -1, -1):
        a = x[j] / pivot[j]
        for p in range(first[j], first[j + 1]):
            a -= entry[p] * x[found[p]]
        x[j] = a
