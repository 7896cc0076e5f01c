"""Whether shapes differ between groups or go with a covariate: permutation tests, and maps of false discovery rates.

Procrustes analysis of variance (Goodall 1991) with residuals permuted: exact under the hypothesis that labels do not
matter. Per point the same is asked of one number, for instance growth, and the rate of false discoveries among points
is controlled as by Benjamini and Hochberg (1995).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from geodesics.arrays import Floats
from geodesics.errors import BadArgument, BadShape
from gmds.morphometrics.components import ALIKE
from gmds.morphometrics.sample_sizes import dealt, least_probability, probability

PERMUTATIONS = 999  # so that the least probability is 0.001: a convention


@dataclass(frozen=True, eq=False)
class ShapeTest:
    """A test of shapes: the share of the variation that is explained, F, and the probability of as much by chance."""

    r_squared: float
    f: float
    p: float
    permutations: int


@dataclass(frozen=True, eq=False)
class PointTests:
    """A test at each point (n,): the slope (or difference of means), its confidence limits, p, and q of discoveries.

    `low`, `high`: of 95 %, by Student's t; NaN where there are fewer than 3 values, or they do not vary. `p`: by
    Student's t as well, but no less than a permutation test of the same values could give (`least_probability`), as
    so few say no more, unless their errors are known to be normal. `q` follows from it.
    """

    slope: Floats
    low: Floats
    high: Floats
    p: Floats
    q: Floats


def design(values: Sequence[str] | ArrayLike) -> Floats:
    """Columns (k, c) that stand for groups (dummies, without the first) or for a covariate (one column)."""
    array = np.asarray(values)
    if array.dtype.kind in "fiu":
        covariate = np.asarray(array, dtype=np.float64)
        if covariate.ndim != 1 or not np.isfinite(covariate).all() or not np.ptp(covariate) > 0:
            raise BadArgument("a covariate must be a finite number for each shape, and not the same for all")
        return covariate[:, None]
    names = sorted(set(array.tolist()))
    if len(names) < 2:
        raise BadArgument(f"there must be two groups or more, not {len(names)}{(names and f' ({names[0]})') or ''}")
    return np.stack([array == name for name in names[1:]], axis=1).astype(np.float64)


def shape_test(shapes: ArrayLike, columns: Floats, *, permutations: int = PERMUTATIONS, rng: int = 0) -> ShapeTest:
    """Procrustes ANOVA: whether aligned shapes (k, n, 3) or (k, d) depend on the columns (k, c) of a design.

    Parameters
    ----------
    shapes : array_like
        Aligned configurations, or scores: distances between them are all that counts.
    columns : float64 array of shape (k, c)
        As `design` makes them.
    permutations : int
        How often rows are drawn anew; where there are 720 ways to deal them out, or fewer, each is taken once.
    rng : int
        Seeds them.

    Returns
    -------
    ShapeTest
        Of the hypothesis that the rows of the design do not matter.

    Raises
    ------
    BadShape
        E108 when there is not a row of the design for every shape.
    BadArgument
        E604 when there are too few shapes, or they are all the same.
    """
    centred, q = centred_and_basis(shapes, columns)
    k = len(centred)
    gram = centred @ centred.T
    total = float(np.trace(gram))
    explained = float(np.trace(q.T @ gram @ q))
    orders, is_all = dealt(columns, permutations, rng)
    others = [float(np.trace(q[order].T @ gram @ q[order])) for order in orders]
    share = explained / total if total > 0 else 0.0
    freedom = q.shape[1]
    f = (explained / max(freedom, 1)) / max((total - explained) / (k - freedom - 1), 1e-300)
    return ShapeTest(share, f, probability(explained, others, is_all, 1e-12), len(orders))


def centred_and_basis(shapes: ArrayLike, columns: Floats) -> tuple[Floats, Floats]:
    """Shapes (k, d) less their mean, and an orthonormal basis (k, c) of what the columns (k, ...) of a design span.

    Raises `BadShape` (E108), `BadArgument` (E604) where there is nothing to test, as `shape_test` says.
    """
    y = np.asarray(shapes, dtype=np.float64)
    if len(y) != len(columns):
        raise BadShape(f"there are {len(y)} shapes and {len(columns)} rows")
    y = y.reshape(len(y), -1)
    if not y.size or not np.isfinite(y).all() or not np.isfinite(columns).all():
        raise BadArgument("a test takes finite numbers, one or more for each shape")
    k, c = columns.shape
    if k < c + 2:
        raise BadArgument(f"{k} shapes are too few for a test with {c + 1} parameters, which takes {c + 2} or more")
    centred = y - y.mean(axis=0)
    if not float((centred**2).sum()) > ALIKE * float((y**2).sum()):
        raise BadArgument("the shapes are all the same, so there is nothing to test")
    x = columns - columns.mean(axis=0)
    u, spread, _ = np.linalg.svd(x, full_matrices=False)
    return centred, u[:, spread > 1e-12 * max(spread[0], 1e-300)]


def point_tests(values: Floats, covariate: Floats) -> PointTests:
    """At each point the regression of values (k, n), NaN where unknown, on a covariate (k,), or on a group (0 or 1)."""
    n = values.shape[1]
    slope, low, high, p = (np.full(n, np.nan) for _ in range(4))
    known = np.isfinite(values)
    for pattern in np.unique(known, axis=1).T:
        some = np.flatnonzero((known == pattern[:, None]).all(axis=0))
        x = covariate[pattern] - covariate[pattern].mean() if pattern.any() else covariate[:0]
        freedom = int(pattern.sum()) - 2
        if freedom < 1 or not (x**2).sum() > 0:
            continue
        y = values[pattern][:, some]
        b = x @ (y - y.mean(axis=0)) / (x**2).sum()
        rest = ((y - y.mean(axis=0) - x[:, None] * b) ** 2).sum(axis=0)
        error = np.sqrt(np.maximum(rest, 1e-300) / freedom / (x**2).sum())
        reach = stats.t.ppf(0.975, freedom) * error
        slope[some], low[some], high[some] = b, b - reach, b + reach
        p[some] = np.maximum(2 * stats.t.sf(np.abs(b) / error, freedom), _least(covariate[pattern]))
    return PointTests(slope, low, high, p, discoveries(p))


def _least(covariate: Floats) -> float:
    """The least p of a permutation test of a covariate (k,), or of two groups that two numbers stand for."""
    two = len(np.unique(covariate)) == 2
    return least_probability(np.where(covariate == covariate[0], "a", "b") if two else covariate)


def discoveries(p: Floats) -> Floats:
    """The least rate of false discoveries (n,) at which each point is one (Benjamini and Hochberg 1995); NaN stays."""
    q = np.full(len(p), np.nan)
    known = np.isfinite(p)
    q[known] = stats.false_discovery_control(p[known]) if known.any() else []
    return q
