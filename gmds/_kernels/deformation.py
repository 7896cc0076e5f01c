"""What a deformation energy sums over edges, features of a moved surface, and what point constraints add up to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics._kernels.jit import njit
from geodesics.arrays import Floats, Integers

Indices = NDArray[np.int32]


@njit
def products(start: Indices, other: Indices, weight: Floats, x: Floats, y: Floats) -> Floats:
    """sum_j w_ij (x_i - x_j)(y_i - y_j)^T, (n, 3, 3); the neighbours of i are `other[start[i]:start[i + 1]]`."""
    total = np.zeros((len(x), 3, 3))
    for i in range(len(x)):
        for p in range(start[i], start[i + 1]):
            j, w = other[p], weight[p]
            u, v = y[i, 0] - y[j, 0], y[i, 1] - y[j, 1]
            t = y[i, 2] - y[j, 2]
            for a in range(3):
                e = w * (x[i, a] - x[j, a])
                total[i, a, 0] += e * u
                total[i, a, 1] += e * v
                total[i, a, 2] += e * t
    return total


@njit
def turned_differences(start: Indices, other: Indices, weight: Floats, x: Floats, local: Floats) -> Floats:
    """Half of sum_j w_ij (M_i + M_j)(x_i - x_j), (n, 3), of matrices M (n, 3, 3)."""
    total = np.zeros((len(x), 3))
    for i in range(len(x)):
        for p in range(start[i], start[i + 1]):
            j, w = other[p], 0.5 * weight[p]
            u, v, t = x[i, 0] - x[j, 0], x[i, 1] - x[j, 1], x[i, 2] - x[j, 2]
            for a in range(3):
                total[i, a] += w * (
                    (local[i, a, 0] + local[j, a, 0]) * u
                    + (local[i, a, 1] + local[j, a, 1]) * v
                    + (local[i, a, 2] + local[j, a, 2]) * t
                )
    return total


@njit
def spread(start: Indices, other: Indices, weight: Floats, y: Floats) -> Floats:
    """sum_j w_ij |y_i - y_j|^2, (n,)."""
    total = np.zeros(len(y))
    for i in range(len(y)):
        for p in range(start[i], start[i + 1]):
            j = other[p]
            u, v, t = y[i, 0] - y[j, 0], y[i, 1] - y[j, 1], y[i, 2] - y[j, 2]
            total[i] += weight[p] * (u * u + v * v + t * t)
    return total


@njit
def positions_and_normals(faces: Integers, y: Floats, weight: float) -> Floats:
    """Positions and unit normals times `weight` (n, 6) of vertices at y (n, 3); normals are means over the faces."""
    rows = np.zeros((len(y), 6))
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        u0, u1, u2 = y[b, 0] - y[a, 0], y[b, 1] - y[a, 1], y[b, 2] - y[a, 2]
        v0, v1, v2 = y[c, 0] - y[a, 0], y[c, 1] - y[a, 1], y[c, 2] - y[a, 2]
        n0, n1, n2 = u1 * v2 - u2 * v1, u2 * v0 - u0 * v2, u0 * v1 - u1 * v0
        for i in (a, b, c):
            rows[i, 3] += n0
            rows[i, 4] += n1
            rows[i, 5] += n2
    for i in range(len(y)):
        size = np.sqrt(rows[i, 3] * rows[i, 3] + rows[i, 4] * rows[i, 4] + rows[i, 5] * rows[i, 5])
        scale = weight / max(size, np.finfo(np.float64).tiny)
        for k in range(3):
            rows[i, k] = y[i, k]
            rows[i, 3 + k] *= scale
    return rows


@njit
def weighted_goals(
    weight: Floats, goal: Floats, back: Integers, weight_back: Floats, place: Floats
) -> tuple[Floats, Floats]:
    """Weights (n,) and weighted means (n, 3) of the goals (n, 3), and of places (q, 3) that the vertices `back` have.

    `weight` (n,) is that of the goals, `weight_back` (q,) that of the places.
    """
    total, sums = weight.copy(), np.empty_like(goal)
    for i in range(len(total)):
        for k in range(3):
            sums[i, k] = weight[i] * goal[i, k]
    for j in range(len(back)):
        i, w = back[j], weight_back[j]
        total[i] += w
        for k in range(3):
            sums[i, k] += w * place[j, k]
    for i in range(len(total)):
        scale = 1 / max(total[i], np.finfo(np.float64).tiny)
        for k in range(3):
            sums[i, k] *= scale
    return total, sums
