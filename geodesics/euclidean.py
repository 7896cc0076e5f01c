"""Distances between sets of vectors: what spectral distances come down to in their embeddings."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats


def euclidean_distances(rows: Floats, others: Floats) -> Floats:
    """|x_i - y_j| for all rows x (p, k) and y (q, k): (p, q), by one matrix product; exact where that would cancel."""
    size = np.einsum("ik,ik->i", rows, rows)[:, None] + np.einsum("ik,ik->i", others, others)
    squared = size - 2 * (rows @ others.T)
    i, j = np.nonzero(squared <= 1e-6 * size)
    squared[i, j] = ((rows[i] - others[j]) ** 2).sum(axis=1)
    return np.sqrt(squared)
