"""Which pairs of samples are asked for, how far apart they are, and what they weigh."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arguments import is_whole, real_numbers
from geodesics.arrays import Floats, Integers
from geodesics.errors import BadArgument
from geodesics.memory import must_fit

HELD = 4  # numbers of a pair that a problem holds: both its samples, their distance, its weight
FEWER_PAIRS = "`pairs=250` asks for those to the first samples alone"
Weights = ArrayLike | Callable[[Floats], Floats] | None
"""Of the samples, of the pairs of samples, or a function of the distances of the pairs; none: all are 1."""


def chosen_pairs(pairs: ArrayLike | int | None, count: int) -> tuple[Integers, Integers]:
    """Index arrays i < j: all pairs, those that one of the first `pairs` samples belongs to, or those asked for."""
    if isinstance(pairs, int | np.integer) and is_whole(pairs):
        return _pairs_of_the_first(int(pairs), count)
    if pairs is None:
        must_fit(HELD * (count * (count - 1) // 2), f"all pairs of {count} samples", FEWER_PAIRS)
        first, second = np.triu_indices(count, 1)
        return first.astype(np.int64), second.astype(np.int64)
    chosen = np.asarray(pairs)
    if chosen.ndim != 2 or chosen.shape[1] != 2 or not np.issubdtype(chosen.dtype, np.integer):
        raise BadArgument(f"pairs must be whole numbers of shape (r, 2), not {chosen.dtype} of shape {chosen.shape}")
    if chosen.size and (chosen.min() < 0 or chosen.max() >= count or (chosen[:, 0] == chosen[:, 1]).any()):
        raise BadArgument(f"pairs must join two different samples of 0 .. {count - 1}")
    chosen = np.unique(np.sort(chosen, axis=1), axis=0).astype(np.int64)
    return np.ascontiguousarray(chosen[:, 0]), np.ascontiguousarray(chosen[:, 1])


def _pairs_of_the_first(heads: int, count: int) -> tuple[Integers, Integers]:
    """Index arrays i < j with i < heads, in the order of i; nothing of count x count is made."""
    if heads < 1:
        raise BadArgument(f"pairs must be those of 1 of the first samples at least, not of {heads}")
    many = count - 1 - np.arange(min(heads, count - 1), dtype=np.int64)
    first = np.repeat(np.arange(len(many), dtype=np.int64), many)
    return first, np.arange(len(first), dtype=np.int64) - np.repeat(np.cumsum(many) - many, many) + first + 1


def pair_weights(weights: Weights, first: Integers, second: Integers, lengths: Floats, count: int) -> Floats:
    """w_ij of each pair, scaled to mean 1."""
    if weights is None:
        return np.ones(len(first))
    if callable(weights):
        pair = np.asarray(weights(lengths), dtype=np.float64)
        if pair.shape != lengths.shape:
            raise BadArgument(f"weights of {len(lengths)} distances must have as many entries, not {pair.shape}")
    else:
        pair = _tabulated_weights(real_numbers(weights, "weights"), first, second, count)
    if not np.isfinite(pair).all() or (pair < 0).any() or not pair.any():
        raise BadArgument("weights must be finite, not negative, and not all zero")
    return pair / pair.mean()


def _tabulated_weights(weights: Floats, first: Integers, second: Integers, count: int) -> Floats:
    """w_ij (r,) from weights of the samples (p,) or of their pairs (p, p)."""
    if weights.shape not in ((count,), (count, count)):
        raise BadArgument(f"weights must have shape ({count},) or ({count}, {count}), not {weights.shape}")
    if (weights < 0).any():
        raise BadArgument("weights must be finite, not negative, and not all zero")
    if weights.ndim == 1:
        return np.asarray(weights[first] * weights[second], dtype=np.float64)
    return np.asarray(0.5 * (weights[first, second] + weights[second, first]), dtype=np.float64)


def tabulated(values: Floats, first: Integers, second: Integers, table: Floats) -> Floats:
    """The table (p, h), with one value a pair (r,) written where both ways round it has a place."""
    for one, other in ((first, second), (second, first)):
        known = other < table.shape[1]
        table[one[known], other[known]] = values[known]
    return table
