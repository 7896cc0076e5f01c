"""Nearest rotations to many 3 x 3 matrices at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics._kernels.jit import njit

Array = NDArray[np.float64]

_SWEEPS = 12


@njit
def nearest_rotations(products: Array) -> tuple[Array, Array]:
    """For each S (n, 3, 3) = sum x y^T the rotation R (n, 3, 3) for which sum y . R x is largest, and that sum (n,).

    The unit quaternion of R is the eigenvector of the largest eigenvalue of a symmetric 4 x 4 matrix (Horn 1987), here
    by Jacobi rotations; that eigenvalue is the sum.
    """
    n = len(products)
    turns, sums = np.empty((n, 3, 3)), np.empty(n)
    m, v = np.empty((4, 4)), np.empty((4, 4))
    for i in range(n):
        s = products[i]
        m[0, 0] = s[0, 0] + s[1, 1] + s[2, 2]
        m[1, 1] = s[0, 0] - s[1, 1] - s[2, 2]
        m[2, 2] = -s[0, 0] + s[1, 1] - s[2, 2]
        m[3, 3] = -s[0, 0] - s[1, 1] + s[2, 2]
        m[0, 1] = m[1, 0] = s[1, 2] - s[2, 1]
        m[0, 2] = m[2, 0] = s[2, 0] - s[0, 2]
        m[0, 3] = m[3, 0] = s[0, 1] - s[1, 0]
        m[1, 2] = m[2, 1] = s[0, 1] + s[1, 0]
        m[1, 3] = m[3, 1] = s[2, 0] + s[0, 2]
        m[2, 3] = m[3, 2] = s[1, 2] + s[2, 1]
        _diagonalise(m, v)
        best = 0
        for k in range(1, 4):
            if m[k, k] > m[best, best]:
                best = k
        sums[i] = m[best, best]
        w, x, y, z = v[0, best], v[1, best], v[2, best], v[3, best]
        turns[i, 0, 0] = w * w + x * x - y * y - z * z
        turns[i, 1, 1] = w * w - x * x + y * y - z * z
        turns[i, 2, 2] = w * w - x * x - y * y + z * z
        turns[i, 0, 1], turns[i, 1, 0] = 2 * (x * y - w * z), 2 * (x * y + w * z)
        turns[i, 0, 2], turns[i, 2, 0] = 2 * (x * z + w * y), 2 * (x * z - w * y)
        turns[i, 1, 2], turns[i, 2, 1] = 2 * (y * z - w * x), 2 * (y * z + w * x)
    return turns, sums


@njit
def _diagonalise(m: Array, v: Array) -> None:
    """Jacobi rotations: on return m (4, 4) is diagonal, and the columns of v (4, 4) are its eigenvectors."""
    size = 0.0
    for a in range(4):
        for b in range(4):
            v[a, b] = 1.0 if a == b else 0.0
            size += m[a, b] * m[a, b]
    for _ in range(_SWEEPS):
        off = 0.0
        for a in range(3):
            for b in range(a + 1, 4):
                off += m[a, b] * m[a, b]
        if off <= 1e-30 * size:
            return
        for a in range(3):
            for b in range(a + 1, 4):
                if m[a, b] == 0.0:
                    continue
                theta = (m[b, b] - m[a, a]) / (2 * m[a, b])
                t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1))
                if theta < 0:
                    t = -t
                c = 1.0 / np.sqrt(t * t + 1)
                s = t * c
                for k in range(4):
                    p, q = m[k, a], m[k, b]
                    m[k, a], m[k, b] = c * p - s * q, s * p + c * q
                for k in range(4):
                    p, q = m[a, k], m[b, k]
                    m[a, k], m[b, k] = c * p - s * q, s * p + c * q
                for k in range(4):
                    p, q = v[k, a], v[k, b]
                    v[k, a], v[k, b] = c * p - s * q, s * p + c * q
