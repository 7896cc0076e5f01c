"""Closest points on an embedded triangle mesh, near a first guess."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics._kernels.jit import njit, summing
from geodesics.arrays import Floats, Integers

Single = NDArray[np.float32]


@summing
def closest_on_faces(
    queries: Floats, rows: Floats, faces: Integers, ring: Integers, start: Integers, guess: Integers, rounds: int
) -> tuple[Integers, Floats, Floats]:
    """Closest points to `queries` (p, k) on the faces around the vertices `guess` (p,), embedded by `rows` (n, k).

    `ring[start[v]:start[v + 1]]` are the faces of vertex v. After each look the guess moves to the corner nearest to
    the closest point, at most `rounds` times. Returns faces (p,), barycentric weights (p, 3) and squared distances.
    """
    p, dim = queries.shape
    face, weight, best = np.full(p, -1, np.int64), np.zeros((p, 3)), np.full(p, np.inf)
    for i in range(p):
        vertex = guess[i]
        for _ in range(rounds):
            before = best[i]
            for slot in range(start[vertex], start[vertex + 1]):
                f = ring[slot]
                a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
                g11, g12, g22, r1, r2, rr = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
                for d in range(dim):
                    e1, e2, x = rows[b, d] - rows[a, d], rows[c, d] - rows[a, d], queries[i, d] - rows[a, d]
                    g11 += e1 * e1
                    g12 += e1 * e2
                    g22 += e2 * e2
                    r1 += e1 * x
                    r2 += e2 * x
                    rr += x * x
                u, v = _in_triangle(g11, g12, g22, r1, r2)
                distance = rr - 2 * (u * r1 + v * r2) + u * u * g11 + 2 * u * v * g12 + v * v * g22
                if distance < best[i]:
                    best[i], face[i] = distance, f
                    weight[i, 0], weight[i, 1], weight[i, 2] = 1 - u - v, u, v
            if not best[i] < before:
                break
            largest = 0
            for corner in range(1, 3):
                if weight[i, corner] > weight[i, largest]:
                    largest = corner
            if faces[face[i], largest] == vertex:
                break
            vertex = faces[face[i], largest]
    return face, weight, best


@summing
def nearest_around(
    queries: Single, rows: Single, neighbours: Integers, start: Integers, guess: Integers, rounds: int
) -> Integers:
    """For each query (p, k) the nearest of the rows (n, k) among those around the row `guess` (p,), and it itself.

    `neighbours[start[v]:start[v + 1]]` are those around row v. The nearest is the guess of the next look, of `rounds`
    at most.
    """
    p, dim = queries.shape
    found = np.empty(p, np.int64)
    half = np.empty(len(rows), rows.dtype)
    for j in range(len(rows)):
        total = rows.dtype.type(0)
        for d in range(dim):
            total += rows[j, d] * rows[j, d]
        half[j] = total / 2
    for i in range(p):
        row = guess[i]
        total = rows.dtype.type(0)
        for d in range(dim):
            total += queries[i, d] * rows[row, d]
        best = half[row] - total
        for _ in range(rounds):
            centre = row
            for slot in range(start[centre], start[centre + 1]):
                other = neighbours[slot]
                total = rows.dtype.type(0)
                for d in range(dim):
                    total += queries[i, d] * rows[other, d]
                gap = half[other] - total
                if gap < best:
                    best, row = gap, other
            if row == centre:
                break
        found[i] = row
    return found


@njit
def _in_triangle(g11: float, g12: float, g22: float, r1: float, r2: float) -> tuple[float, float]:
    """The point u e1 + v e2 of a triangle nearest to x, from the products of e1, e2 and x.

    By the region of the plane that x lies over (Ericson: Real-time collision detection, 2005, sec. 5.1.5).
    """
    if g11 * g22 - g12 * g12 <= 1e-14 * g11 * g22:
        return _on_edges(g11, g12, g22, r1, r2)
    if r1 <= 0.0 and r2 <= 0.0:
        return 0.0, 0.0
    b1, b2 = r1 - g11, r2 - g12
    if b1 >= 0.0 and b2 <= b1:
        return 1.0, 0.0
    beyond_first = r1 * b2 - b1 * r2
    if beyond_first <= 0.0 and r1 >= 0.0 and b1 <= 0.0:
        return r1 / g11, 0.0
    c1, c2 = r1 - g12, r2 - g22
    if c2 >= 0.0 and c1 <= c2:
        return 0.0, 1.0
    beyond_second = c1 * r2 - r1 * c2
    if beyond_second <= 0.0 and r2 >= 0.0 and c2 <= 0.0:
        return 0.0, r2 / g22
    beyond_third = b1 * c2 - c1 * b2
    if beyond_third <= 0.0 and b2 >= b1 and c1 >= c2:
        v = (b2 - b1) / ((b2 - b1) + (c1 - c2))
        return 1.0 - v, v
    scale = 1.0 / (beyond_first + beyond_second + beyond_third)
    return beyond_second * scale, beyond_first * scale


@njit
def _on_edges(g11: float, g12: float, g22: float, r1: float, r2: float) -> tuple[float, float]:
    """The same for a triangle without area: the nearest point of its edges."""
    best_u, best_v, best = 0.0, 0.0, np.inf
    for edge in range(3):
        if edge == 0:
            t = r1 / g11 if g11 > 0 else 0.0
            t = min(max(t, 0.0), 1.0)
            u, v = t, 0.0
        elif edge == 1:
            t = r2 / g22 if g22 > 0 else 0.0
            t = min(max(t, 0.0), 1.0)
            u, v = 0.0, t
        else:
            length = g11 - 2 * g12 + g22
            t = (r2 - r1 - g12 + g11) / length if length > 0 else 0.0
            t = min(max(t, 0.0), 1.0)
            u, v = 1 - t, t
        value = -2 * (u * r1 + v * r2) + u * u * g11 + 2 * u * v * g12 + v * v * g22
        if value < best:
            best_u, best_v, best = u, v, value
    return best_u, best_v
