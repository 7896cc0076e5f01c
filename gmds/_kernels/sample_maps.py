"""Refinement of a sample map, from matrix to images to the next matrix, without the interpreter in between."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics._kernels.jit import njit, summing
from geodesics.arrays import Floats, Integers

Single = NDArray[np.float32]

_FORMS = 10  # d phi_i ^ d phi_j, 1 <= i < j <= 5


@njit
def refined(
    images: Integers,
    steps: Integers,
    inverses: Floats,
    ours: Single,
    theirs: Floats,
    forms: Single,
    others: Floats,
    scale: Floats,
) -> Integers:
    """The images (p,) of samples among q, refined with ever more eigenfunctions: `steps` (s, 2) of (i, k).

    `inverses[i, :k]` (k, p) is the pseudo-inverse of the first k functions of the source; the others as in `placed`.
    """
    for step in range(len(steps)):
        i, k = steps[step]
        sent = np.empty((len(images), k))
        for j in range(len(images)):
            sent[j] = theirs[images[j], :k]
        images = placed(np.dot(inverses[i, :k], sent), ours, theirs, forms, others, scale)
    return images


@njit
def placed(matrix: Floats, ours: Single, theirs: Floats, forms: Single, others: Floats, scale: Floats) -> Integers:
    """The images (p,) among q samples of a functional map C (k, k), functions and orientation forms taken together.

    `ours` (p, K), `theirs` (q, K): eigenfunctions; `forms` (p, 10), `others` (q, 10): orientation forms, the first
    rooted and scaled by `scale` (10,), as the others are once they are pulled back.
    """
    k, width = len(matrix), len(matrix) + _FORMS + 1
    moved = np.dot(np.ascontiguousarray(theirs[:, :k]), np.ascontiguousarray(matrix.T))
    pulled = np.dot(others, np.ascontiguousarray(minors(matrix).T))
    rows = np.empty((len(theirs), width), dtype=np.float32)
    for j in range(len(theirs)):
        norm = np.float32(0)
        for a in range(width - 1):
            x = moved[j, a] if a < k else np.sign(pulled[j, a - k]) * np.sqrt(np.abs(pulled[j, a - k])) * scale[a - k]
            value = np.float32(x)
            rows[j, a] = -value
            norm += value * value
        rows[j, k + _FORMS] = np.float32(0.5) * norm  # |r|^2 / 2 - q . r in one product
    queries = np.ones((len(ours), width), dtype=np.float32)
    queries[:, :k] = ours[:, :k]
    queries[:, k : k + _FORMS] = forms
    return _smallest(np.dot(queries, np.ascontiguousarray(rows.T)))


@njit
def minors(matrix: Floats) -> Floats:
    """The minors M (10, 10) of rows i < j and columns k < l of C, of the first five functions after the constant.

    Forms (p, 10) of the target's functions are forms M^T as those of the source's.
    """
    result = np.empty((_FORMS, _FORMS))
    row = 0
    for i in range(1, 6):
        for j in range(i + 1, 6):
            column = 0
            for k in range(1, 6):
                for m in range(k + 1, 6):
                    result[row, column] = matrix[i, k] * matrix[j, m] - matrix[i, m] * matrix[j, k]
                    column += 1
            row += 1
    return result


@njit
def _smallest(rows: Single) -> Integers:
    """The column of the smallest entry of each row, the first of them."""
    result = np.empty(len(rows), dtype=np.int64)
    bits = rows.view(np.int32)
    for i in range(len(rows)):
        # bits of floats in the order of the floats, as whole numbers several are compared at a time
        least = np.int32(2147483647)
        for j in range(bits.shape[1]):
            key = bits[i, j] ^ ((bits[i, j] >> np.int32(31)) & np.int32(2147483647))
            least = min(least, key)
        least ^= (least >> np.int32(31)) & np.int32(2147483647)
        best = 0
        while bits[i, best] != least:
            best += 1
        result[i] = best
    return result


@summing
def mean_difference(ours: Floats, theirs: Floats, images: Integers) -> float:
    """Mean |d_ij - e_kl| of distances d (p, p) and e (q, q), where i goes to k and j to l: `images` (p,)."""
    total = 0.0
    for i in range(len(ours)):
        for j in range(len(ours)):
            total += abs(ours[i, j] - theirs[images[i], images[j]])
    return total / ours.size
