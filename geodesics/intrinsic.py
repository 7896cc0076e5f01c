"""Triangle formulas that need only squared edge lengths (m, 3); edge k is opposite corner k."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def squared_lengths(vertices: Array, faces: NDArray[np.int64]) -> Array:
    """Squared edge lengths (m, 3); column k is the edge opposite corner k."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.stack([((b - c) ** 2).sum(1), ((c - a) ** 2).sum(1), ((a - b) ** 2).sum(1)], axis=1)


def areas(l_sq: Array) -> Array:
    """Triangle areas (m,) by Heron's formula in Kahan's stable ordering."""
    a, b, c = np.sort(np.sqrt(l_sq), axis=1).T[::-1]
    product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))
    return 0.25 * np.sqrt(np.maximum(product, 0))


def cotangents(l_sq: Array) -> Array:
    """Cotangents (m, 3) of the corner angles: cot_k = (sum of the other two - l_k^2) / (4 area)."""
    return (l_sq.sum(1, keepdims=True) - 2 * l_sq) / (4 * np.maximum(areas(l_sq), 1e-300))[:, None]


def angles(l_sq: Array) -> Array:
    """Corner angles (m, 3) in radians."""
    opposite_sum = l_sq.sum(1, keepdims=True) - 2 * l_sq
    return np.arctan2(4 * areas(l_sq)[:, None], opposite_sum)
