"""Products with a Jacobian whose every row touches two points only."""

from __future__ import annotations

import numpy as np

from geodesics._kernels.jit import njit
from geodesics.arrays import Floats, Integers


@njit
def multiply(first: Integers, second: Integers, blocks: Floats, step: Floats) -> Floats:
    """Row r is blocks[r, 0] . step[first[r]] + blocks[r, 1] . step[second[r]]; step is (p, 2)."""
    out = np.empty(len(first))
    for r in range(len(first)):
        i, j = first[r], second[r]
        out[r] = (
            blocks[r, 0, 0] * step[i, 0]
            + blocks[r, 0, 1] * step[i, 1]
            + blocks[r, 1, 0] * step[j, 0]
            + blocks[r, 1, 1] * step[j, 1]
        )
    return out


@njit
def multiply_transposed(first: Integers, second: Integers, blocks: Floats, rows: Floats, n_points: int) -> Floats:
    """The transpose of `multiply` applied to rows (r,): shape (n_points, 2)."""
    out = np.zeros((n_points, 2))
    for r in range(len(first)):
        i, j, value = first[r], second[r], rows[r]
        out[i, 0] += blocks[r, 0, 0] * value
        out[i, 1] += blocks[r, 0, 1] * value
        out[j, 0] += blocks[r, 1, 0] * value
        out[j, 1] += blocks[r, 1, 1] * value
    return out


@njit
def weighted_normal(first: Integers, second: Integers, blocks: Floats, weights: Floats, step: Floats) -> Floats:
    """J^T diag(weights) J step, in one pass: shape (p, 2)."""
    out = np.zeros_like(step)
    for r in range(len(first)):
        i, j = first[r], second[r]
        value = weights[r] * (
            blocks[r, 0, 0] * step[i, 0]
            + blocks[r, 0, 1] * step[i, 1]
            + blocks[r, 1, 0] * step[j, 0]
            + blocks[r, 1, 1] * step[j, 1]
        )
        out[i, 0] += blocks[r, 0, 0] * value
        out[i, 1] += blocks[r, 0, 1] * value
        out[j, 0] += blocks[r, 1, 0] * value
        out[j, 1] += blocks[r, 1, 1] * value
    return out


@njit
def second_moments(first: Integers, second: Integers, blocks: Floats, n_points: int) -> Floats:
    """Sum over the rows of each point of the outer product of its block: (n_points, 3) = xx, xy, yy."""
    out = np.zeros((n_points, 3))
    for r in range(len(first)):
        for side in range(2):
            i = first[r] if side == 0 else second[r]
            x, y = blocks[r, side, 0], blocks[r, side, 1]
            out[i, 0] += x * x
            out[i, 1] += x * y
            out[i, 2] += y * y
    return out


@njit
def change_frames(first: Integers, second: Integers, blocks: Floats, frames: Floats) -> Floats:
    """Every block times the frame (2, 2) of its point, in a new array."""
    out = np.empty_like(blocks)
    for r in range(len(first)):
        for side in range(2):
            i = first[r] if side == 0 else second[r]
            x, y = blocks[r, side, 0], blocks[r, side, 1]
            out[r, side, 0] = x * frames[i, 0, 0] + y * frames[i, 1, 0]
            out[r, side, 1] = x * frames[i, 0, 1] + y * frames[i, 1, 1]
    return out
