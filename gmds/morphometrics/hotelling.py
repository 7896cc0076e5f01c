"""Whether mean shapes differ, by Hotelling's T squared of principal components, with the probability by permutation.

Where Procrustes analysis of variance takes every direction of shape alike, T squared measures differences by how much
specimens vary in each: small differences where nothing varies otherwise are found by it, and by that alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats
from gmds.morphometrics.components import principal_components
from gmds.morphometrics.group_tests import PERMUTATIONS, centred_and_basis
from gmds.morphometrics.sample_sizes import dealt, probability

ENOUGH = 0.95  # share of the variation that the components have together: a convention


@dataclass(frozen=True, eq=False)
class HotellingTest:
    """T squared, of how many principal components, and the probability of as much by chance."""

    t_squared: float
    components: int
    p: float
    permutations: int


def hotelling_test(
    shapes: ArrayLike, columns: Floats, *, permutations: int = PERMUTATIONS, rng: int = 0
) -> HotellingTest:
    r"""Hotelling's T squared: whether aligned shapes (k, n, 3) or (k, d) depend on the columns (k, c) of a design.

    For two groups of :math:`a` and :math:`b` specimens, with mean scores that differ by :math:`\delta` and the pooled
    covariance S of scores within groups,

    .. math:: T^2 = \frac{a b}{a + b} \, \delta^T S^{-1} \delta

    For more groups or a covariate it is :math:`k - c - 1` times the trace of Hotelling and Lawley, which is the same.
    Scores are those of the first principal components of all specimens, as many as have 95 % of the variation, and at
    most half of what there are degrees of freedom, so that S can be told.

    Parameters
    ----------
    shapes : array_like
        Aligned configurations, or numbers of each specimen such as growth.
    columns : float64 array of shape (k, c)
        As `design` makes them.
    permutations : int
        How often rows are drawn anew, as of `shape_test`.
    rng : int
        Seeds them.

    Returns
    -------
    HotellingTest
        Of the hypothesis that the rows of the design do not matter.

    Raises
    ------
    BadShape, BadArgument
        E108, E604 as of `shape_test`.

    References
    ----------
    Hotelling: The generalization of Student's ratio (1931). Klingenberg, Monteiro: Distances and directions in
    multidimensional shape spaces (2005).

    See Also
    --------
    shape_test : Procrustes analysis of variance.
    """
    centred, q = centred_and_basis(shapes, columns)
    k, c = q.shape
    variance, axes = principal_components(centred)
    enough = int(np.searchsorted(variance.cumsum(), ENOUGH * variance.sum())) + 1
    count = max(1, min(enough, (k - c - 1) // 2, len(variance)))
    scores = centred @ axes[:count].T
    white = np.linalg.svd(scores, full_matrices=False)[0]  # the trace does not depend on the units of components
    found = _trace(white, q)
    orders, is_all = dealt(columns, permutations, rng)
    p = probability(found, [_trace(white, q[order]) for order in orders], is_all, 1e-9)
    return HotellingTest((k - c - 1) * found, count, p, len(orders))


def _trace(white: Floats, q: Floats) -> float:
    """tr(H E^-1) of orthonormal scores and an orthonormal design: a sum over squared canonical correlations."""
    squares = np.clip(np.linalg.svd(white.T @ q, compute_uv=False) ** 2, 0.0, 1 - 1e-12)
    return float((squares / (1 - squares)).sum())
