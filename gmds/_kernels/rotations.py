"""Nearest rotations to many 3 x 3 matrices at once."""

from __future__ import annotations

import numpy as np

from geodesics._kernels.jit import njit
from geodesics.arrays import Floats

_STEPS = 60  # of Newton, at the most: a bound
_SWEEPS = 12  # of Jacobi, at the most: a bound, they converge quadratically
_TOLERANCE = 1e-14  # of the eigenvalue, relative: some fifty roundings
# Slope of the characteristic polynomial at the root, over the cube of the root, that Newton can rely on: set by hand,
# the tests compare both ways around it.
_CLEAR = 1e-4


@njit
def nearest_rotations(products: Floats) -> tuple[Floats, Floats]:
    """For each S (n, 3, 3) = sum x y^T the rotation R (n, 3, 3) for which sum y . R x is largest, and that sum (n,).

    The unit quaternion of R is the eigenvector of the largest eigenvalue of a symmetric 4 x 4 matrix M without trace
    (Horn 1987); that eigenvalue is the sum. Newton's iteration descends to it as a root of the characteristic
    polynomial, and the adjugate of M minus it is a multiple of q q^T (as Theobald 2005); where the next eigenvalue is
    too near for that, all are found by Jacobi rotations.
    """
    n = len(products)
    rotations, sums = np.empty((n, 3, 3)), np.empty(n)
    m, v, q = np.empty((4, 4)), np.empty((4, 4)), np.empty(4)
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
        top = _largest(m, s, v, q)
        if top < 0:
            _diagonalise(m, v)
            best = 0
            for k in range(1, 4):
                if m[k, k] > m[best, best]:
                    best = k
            top = m[best, best]
            for k in range(4):
                q[k] = v[k, best]
        sums[i] = top
        w, x, y, z = q[0], q[1], q[2], q[3]
        rotations[i, 0, 0] = w * w + x * x - y * y - z * z
        rotations[i, 1, 1] = w * w - x * x + y * y - z * z
        rotations[i, 2, 2] = w * w - x * x - y * y + z * z
        rotations[i, 0, 1], rotations[i, 1, 0] = 2 * (x * y - w * z), 2 * (x * y + w * z)
        rotations[i, 0, 2], rotations[i, 2, 0] = 2 * (x * z + w * y), 2 * (x * z - w * y)
        rotations[i, 1, 2], rotations[i, 2, 1] = 2 * (y * z - w * x), 2 * (y * z + w * x)
    return rotations, sums


@njit
def _largest(m: Floats, s: Floats, a: Floats, q: Floats) -> float:
    """The largest eigenvalue of m (4, 4), and its unit eigenvector in q (4,); -1 where the next is too near.

    The characteristic polynomial is x^4 - 2 |S|^2 x^2 - 8 det(S) x + det(M).
    """
    square = 0.0
    for j in range(3):
        for k in range(3):
            square += s[j, k] * s[j, k]
    if square <= 0.0:
        return -1.0
    volume = (
        s[0, 0] * (s[1, 1] * s[2, 2] - s[1, 2] * s[2, 1])
        - s[0, 1] * (s[1, 0] * s[2, 2] - s[1, 2] * s[2, 0])
        + s[0, 2] * (s[1, 0] * s[2, 1] - s[1, 1] * s[2, 0])
    )
    c2, c1, c0 = -2 * square, -8 * volume, _determinant(m)
    x = np.sqrt(3 * square)  # no eigenvalue is larger; from there on Newton's steps only go down
    for _ in range(_STEPS):
        slope = (4 * x * x + 2 * c2) * x + c1  # at a root, the product of its distances from the others
        if slope <= _CLEAR * x * x * x:
            return -1.0
        step = ((x * x + c2) * x * x + c1 * x + c0) / slope
        x -= step
        if step <= _TOLERANCE * x:
            break
    best = -1.0
    for j in range(4):
        for k in range(4):
            a[j, k] = m[j, k] - (x if j == k else 0.0)
    for k in range(4):
        value = abs(_cofactor(a, k, k))
        if value > best:
            best, row = value, k
    size = 0.0
    for k in range(4):
        q[k] = _cofactor(a, row, k)
        size += q[k] * q[k]
    size = np.sqrt(size)
    for k in range(4):
        q[k] /= size
    return x


@njit
def _cofactor(a: Floats, row: int, column: int) -> float:
    """The cofactor of an entry of a (4, 4)."""
    i, j, k = (row + 1) % 4, (row + 2) % 4, (row + 3) % 4
    p, q, r = (column + 1) % 4, (column + 2) % 4, (column + 3) % 4
    value = (
        a[i, p] * (a[j, q] * a[k, r] - a[j, r] * a[k, q])
        - a[i, q] * (a[j, p] * a[k, r] - a[j, r] * a[k, p])
        + a[i, r] * (a[j, p] * a[k, q] - a[j, q] * a[k, p])
    )
    # three cyclic shifts of four are an odd permutation
    return value if (row + column) % 2 == 0 else -value


@njit
def _determinant(a: Floats) -> float:
    """The determinant of a (4, 4)."""
    return (
        a[0, 0] * _cofactor(a, 0, 0)
        + a[0, 1] * _cofactor(a, 0, 1)
        + a[0, 2] * _cofactor(a, 0, 2)
        + a[0, 3] * _cofactor(a, 0, 3)
    )


@njit
def _diagonalise(m: Floats, v: Floats) -> None:
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
