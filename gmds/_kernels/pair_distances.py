"""Distances of chosen pairs of points in an embedding, and how they change when the points move."""

from __future__ import annotations

import numpy as np

from geodesics._kernels.jit import njit, summing
from geodesics.arrays import Floats, Integers


@summing
def lengths(first: Integers, second: Integers, rows: Floats, signature: Floats) -> Floats:
    """|rows[first] - rows[second]| (r,) where squares count as the signature (k,) says; rows is (p, k)."""
    out = np.empty(len(first))
    for r in range(len(first)):
        i, j = first[r], second[r]
        total = 0.0
        for c in range(len(signature)):
            gap = rows[i, c] - rows[j, c]
            total += signature[c] * gap * gap
        out[r] = np.sqrt(max(total, 0.0))
    return out


@njit
def lengths_of_products(first: Integers, second: Integers, gram: Floats) -> Floats:
    """The same where the products (p, p) of all rows with all rows are known."""
    out = np.empty(len(first))
    for r in range(len(first)):
        i, j = first[r], second[r]
        out[r] = np.sqrt(max(gram[i, i] + gram[j, j] - (gram[i, j] + gram[j, i]), 0.0))
    return out


@summing
def slopes(
    first: Integers,
    second: Integers,
    rows: Floats,
    signature: Floats,
    gradients: Floats,
    lengths: Floats,
    scale: Floats,
) -> Floats:
    """(r, 2, 2): (rows_i - rows_j) . gradients_i / length_r scale_r, and the same of j; gradients is (p, 2, k).

    Where a length is 0, so are they.
    """
    out = np.empty((len(first), 2, 2))
    for r in range(len(first)):
        i, j = first[r], second[r]
        ix, iy, jx, jy = 0.0, 0.0, 0.0, 0.0
        for c in range(len(signature)):
            gap = signature[c] * (rows[i, c] - rows[j, c])
            ix += gap * gradients[i, 0, c]
            iy += gap * gradients[i, 1, c]
            jx -= gap * gradients[j, 0, c]
            jy -= gap * gradients[j, 1, c]
        factor = scale[r] / lengths[r] if lengths[r] > 0 else 0.0
        out[r, 0, 0], out[r, 0, 1] = ix * factor, iy * factor
        out[r, 1, 0], out[r, 1, 1] = jx * factor, jy * factor
    return out


@njit
def slopes_of_products(first: Integers, second: Integers, product: Floats, lengths: Floats, scale: Floats) -> Floats:
    """The same where gradients_i . rows_j are known for all i and j, (p, 2, p)."""
    out = np.empty((len(first), 2, 2))
    for r in range(len(first)):
        i, j = first[r], second[r]
        inverse = 1 / lengths[r] if lengths[r] > 0 else 0.0
        out[r, 0, 0] = (product[i, 0, i] - product[i, 0, j]) * inverse * scale[r]
        out[r, 0, 1] = (product[i, 1, i] - product[i, 1, j]) * inverse * scale[r]
        out[r, 1, 0] = (product[j, 0, j] - product[j, 0, i]) * inverse * scale[r]
        out[r, 1, 1] = (product[j, 1, j] - product[j, 1, i]) * inverse * scale[r]
    return out


@njit
def field_lengths(first: Integers, second: Integers, fields: Floats, corners: Integers, weights: Floats) -> Floats:
    """Fields (p, n) of points `first` at points `second`, (r,): at their corners (q, 3), by barycentric weights (q, 3).

    A corner without weight has no say, also where its field is infinite.
    """
    out = np.empty(len(first))
    for r in range(len(first)):
        i, j = first[r], second[r]
        total = 0.0
        for c in range(3):
            if weights[j, c] != 0:
                total += weights[j, c] * fields[i, corners[j, c]]
        out[r] = total
    return out


@njit
def field_slopes(
    first: Integers, second: Integers, fields: Floats, corners: Integers, gradients: Floats, scale: Floats
) -> Floats:
    """(r, 2, 2): slopes of the field of each second point at the first, times scale_r, and of the first at the second.

    `gradients` (p, 3, 2) are those of the barycentric weights. Where a field is infinite at a corner the slope is 0.
    """
    out = np.zeros((len(first), 2, 2))
    for r in range(len(first)):
        for side in range(2):
            at, of = (first[r], second[r]) if side == 0 else (second[r], first[r])
            x, y = 0.0, 0.0
            for c in range(3):
                value = fields[of, corners[at, c]]
                x += value * gradients[at, c, 0]
                y += value * gradients[at, c, 1]
            if np.isfinite(x) and np.isfinite(y):
                out[r, side, 0], out[r, side, 1] = x * scale[r], y * scale[r]
    return out
