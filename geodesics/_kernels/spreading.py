"""Which rows are closer to a new one than to all before: the inner loop of farthest-point sampling in an embedding."""

from __future__ import annotations

import numpy as np

from geodesics._kernels.jit import njit
from geodesics.arrays import Floats, Integers


@njit
def closer_rows(rows: Floats, label: Integers, row: int, nearest: Floats) -> tuple[Integers, Floats]:
    """The rows (n, k) whose distance from `row` is less than their `nearest` (n,), and that distance.

    Rows with a negative `label` (n,) do not count, nor those with another than that of `row`.
    """
    n, dim = rows.shape
    where, values, count = np.empty(n, np.int64), np.empty(n), 0
    for i in range(n):
        if label[i] < 0 or label[i] != label[row]:
            continue
        limit, total = nearest[i] * nearest[i], 0.0
        for d in range(dim):
            gap = rows[i, d] - rows[row, d]
            total += gap * gap
            if total >= limit:
                break
        if total < limit and np.sqrt(total) < nearest[i]:
            where[count], values[count] = i, np.sqrt(total)
            count += 1
    return where[:count], values[:count]
