"""Which pairs of samples are asked for, how far apart they are, and what they weigh."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats, Integers
from geodesics.errors import BadArgument
from gmds.mds.pair_distances import EmbeddedPairs, Pairs


def lengths_of(pairs: Pairs, first: Integers, second: Integers) -> Floats:
    """Distances (r,) of some pairs of the points."""
    if isinstance(pairs, EmbeddedPairs):
        return pairs.lengths(first, second)
    return pairs.distances()[first, second]


def chosen_pairs(pairs: ArrayLike | None, count: int) -> tuple[Integers, Integers]:
    """Index arrays i < j: all pairs, or those asked for."""
    if pairs is None:
        first, second = np.triu_indices(count, 1)
        return first.astype(np.int64), second.astype(np.int64)
    chosen = np.asarray(pairs)
    if chosen.ndim != 2 or chosen.shape[1] != 2 or not np.issubdtype(chosen.dtype, np.integer):
        raise BadArgument(f"pairs must be whole numbers of shape (r, 2), not {chosen.dtype} of shape {chosen.shape}")
    if chosen.size and (chosen.min() < 0 or chosen.max() >= count or (chosen[:, 0] == chosen[:, 1]).any()):
        raise BadArgument(f"pairs must join two different samples of 0 .. {count - 1}")
    chosen = np.unique(np.sort(chosen, axis=1), axis=0).astype(np.int64)
    return np.ascontiguousarray(chosen[:, 0]), np.ascontiguousarray(chosen[:, 1])


def pair_weights(weights: ArrayLike | None, first: Integers, second: Integers, count: int) -> Floats:
    """w_ij of each pair, scaled to mean 1."""
    if weights is None:
        return np.ones(len(first))
    w = np.asarray(weights, dtype=np.float64)
    if w.shape not in ((count,), (count, count)):
        raise BadArgument(f"weights must have shape ({count},) or ({count}, {count}), not {w.shape}")
    pair = w[first] * w[second] if w.ndim == 1 else 0.5 * (w[first, second] + w[second, first])
    if not np.isfinite(pair).all() or (pair < 0).any() or not pair.any():
        raise BadArgument("weights must be finite, not negative, and not all zero")
    return pair / pair.mean()
