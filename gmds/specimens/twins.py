"""Specimens that are one and the same shape, as a file that is in a folder twice."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geodesics.arrays import Floats

SAME = 1e-6  # distance of two configurations, over the root of their mean square: copies come to 1e-8, rounding


def same_shapes(names: Sequence[str], aligned: Floats) -> list[tuple[str, ...]]:
    """Names of specimens whose superimposed configurations (k, n, 3) are the same, together.

    Examples
    --------
    >>> one, other = np.eye(3)[None], np.ones((1, 3, 3))
    >>> same_shapes(["a", "b", "c"], np.concatenate([one, other, one]))
    [('a', 'c')]
    """
    flat = aligned.reshape(len(aligned), -1)
    gram = flat @ flat.T
    squares = np.diag(gram)
    apart = squares[:, None] + squares - 2 * gram
    same = apart < SAME**2 * max(float(squares.mean()), 1e-300)
    together = dict.fromkeys(tuple(np.flatnonzero(row).tolist()) for row in same)
    return [tuple(names[i] for i in some) for some in together if len(some) > 1]
