"""How far off points of an atlas may be, from how far what is said of them disagrees."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geodesics.arrays import Bools, Floats

# Root areas, and times the spread: what all accounts share is not in the spread. Within their sum are nine of ten
# points of each development set of `benchmarks.study.spread` (benchmarks/results/spread.md).
SHARED = 0.02
TIMES = 3.0
FAR = 0.1  # root areas, twice that within which a point counts as right
DOUBTED = 0.01  # share of the points of a specimen that may be as far off; set by hand


def error_bars(spread: Floats) -> Floats:
    """Root areas within which nine of ten points are, for a `spread` of any shape; NaN where there is none."""
    return np.asarray(SHARED + TIMES * spread, dtype=np.float64)


def doubtful(names: tuple[str, ...], spread: Floats, valid: Bools) -> Mapping[str, float]:
    """Specimens of which more than 1 % of the points there are may be off by 0.1 root areas: that share, by name.

    Examples
    --------
    >>> spread, there = np.array([[0.01, 0.01], [0.01, 0.05]]), np.ones((2, 2), bool)
    >>> doubtful(("sure", "unsure"), spread, there)
    {'unsure': 0.5}
    """
    far = (error_bars(np.nan_to_num(spread)) > FAR) & valid
    shares = far.sum(axis=1) / np.maximum(valid.sum(axis=1), 1)
    return {name: float(share) for name, share in zip(names, shares, strict=True) if share > DOUBTED}
