"""Solving with sparse triangular factors for eight right-hand sides at once: each entry is read once for all."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from geodesics._kernels.jit import inlined, uncounted
from geodesics.arrays import Floats

Indices = NDArray[np.int32]

WIDTH = 8  # right-hand sides at a time, by hand as eight scalars, which stay in registers where an array would not


class Triangle(NamedTuple):
    """A triangular matrix by columns with ascending indices: column i is entries start[i] to start[i + 1]."""

    start: Indices
    row: Indices
    value: Floats


@inlined
def _subtract(row: Indices, value: Floats, first: int, last: int, i: int, work: Floats) -> None:
    """Take from row i of work the rows that entries `first` to `last` of a column name, times their values."""
    a, b, c, d = work[i, 0], work[i, 1], work[i, 2], work[i, 3]
    e, f, g, h = work[i, 4], work[i, 5], work[i, 6], work[i, 7]
    for p in range(first, last):
        j, v = row[p], value[p]
        a -= v * work[j, 0]
        b -= v * work[j, 1]
        c -= v * work[j, 2]
        d -= v * work[j, 3]
        e -= v * work[j, 4]
        f -= v * work[j, 5]
        g -= v * work[j, 6]
        h -= v * work[j, 7]
    work[i, 0], work[i, 1], work[i, 2], work[i, 3] = a, b, c, d
    work[i, 4], work[i, 5], work[i, 6], work[i, 7] = e, f, g, h


@uncounted
def substitute(upper: Triangle, lower: Triangle, work: Floats) -> None:
    """Replace work (n, 8) by the solution x of U^T L^T x = work, where L has ones on its diagonal."""
    start, row, value = upper.start, upper.row, upper.value
    for i in range(work.shape[0]):
        pivot = start[i + 1] - 1
        _subtract(row, value, start[i], pivot, i, work)
        for k in range(WIDTH):
            work[i, k] /= value[pivot]
    start, row, value = lower.start, lower.row, lower.value
    for i in range(work.shape[0] - 1, -1, -1):
        _subtract(row, value, start[i] + 1, start[i + 1], i, work)
