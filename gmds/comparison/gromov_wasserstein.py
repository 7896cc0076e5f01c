"""Bounds of the Gromov-Wasserstein distance: three from below, one from above."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import cdist

from geodesics.arrays import Floats, Integers
from geodesics.errors import BadArgument
from gmds.comparison.gromov_hausdorff import Bounds, finite_square, partners_given

STEPS = 50  # conditional gradients, at the most: a bound, descents of 100 points take about ten
ORDERS = (1, 2)  # a convention: means, and root mean squares


def gromov_wasserstein_bounds(
    first: ArrayLike, second: ArrayLike, *, order: int = 2, start: ArrayLike | None = None
) -> Bounds:
    r"""Bounds of the Gromov-Wasserstein distance of two sets of p samples that stand for equal areas (sec. 5).

    .. math:: d_{GW} = \frac12 \min_\mu
              \Big( \sum_{x,y,x',y'} |d_S(x, x') - d_Q(y, y')|^r \, \mu_{xy} \mu_{x'y'} \Big)^{1/r}

    over the couplings :math:`\mu` of equal weights 1/p. Below: the largest of Memoli's three bounds, by the
    distributions of eccentricities, of all distances, and of the distances from each sample, the samples assigned to
    each other (the tightest as a rule). Above: the cost of a one-to-one coupling, found by conditional gradients.

    Parameters
    ----------
    first, second : array_like of shape (p, p)
        Distances among samples of each surface.
    order : {1, 2}
        r: the mean of distortions, or the root of the mean of their squares.
    start : array_like of int, shape (p,), optional
        Where to begin from above: the partner of each sample, a permutation.

    Returns
    -------
    Bounds
        `lower` <= d_GW <= `upper`.

    Raises
    ------
    ValueError
        For matrices that are no distances or of different sizes, another order, or a start that is no permutation.

    References
    ----------
    Memoli: Gromov-Wasserstein distances and the metric approach to object matching (2011), sec. 6: the first, second
    and third lower bound.

    See Also
    --------
    gromov_hausdorff_bounds : Maxima in place of means.
    least_distortion : Twice the third lower bound with r = 1, in two metrics, for many shapes.

    Examples
    --------
    >>> import gmds
    >>> one = [[0, 1, 2], [1, 0, 1], [2, 1, 0]]  # distances among three points
    >>> bounds = gmds.gromov_wasserstein_bounds(one, one)
    >>> float(round(bounds.upper, 6))
    0.0
    """
    a, b = finite_square(first), finite_square(second)
    if order not in ORDERS:
        raise BadArgument(f"order must be one of {', '.join(map(str, ORDERS))}, not {order!r}")
    if a.shape != b.shape:
        raise BadArgument(f"as many samples are needed of both surfaces, not {len(a)} and {len(b)}")
    local = cdist(np.sort(a, axis=1), np.sort(b, axis=1), _power_mean, r=order) ** order
    assigned = linear_sum_assignment(local)
    third = 0.5 * float(local[assigned].mean()) ** (1 / order)
    second_bound = 0.5 * _power_mean(np.sort(a.ravel()), np.sort(b.ravel()), order)
    eccentricity = [np.sort((d**order).mean(axis=1) ** (1 / order)) for d in (a, b)]
    first_bound = 0.5 * _power_mean(eccentricity[0], eccentricity[1], order)
    begin = assigned[1] if start is None else partners_given(start, len(a), len(b))
    if len(np.unique(begin)) < len(a):
        raise BadArgument("start must be a permutation: each sample of the second is the partner of one of the first")
    upper = 0.5 * _cost(a, b, _descended(a, b, begin, order), order) ** (1 / order)
    return Bounds(max(first_bound, second_bound, third), upper)


def _power_mean(x: Floats, y: Floats, r: int) -> float:
    return float((np.abs(x - y) ** r).mean() ** (1 / r))


def _cost(a: Floats, b: Floats, images: Integers, order: int) -> float:
    """The mean of |d - d|^r under a one-to-one coupling."""
    return float((np.abs(a - b[np.ix_(images, images)]) ** order).mean())


def _descended(a: Floats, b: Floats, images: Integers, order: int) -> Integers:
    """A permutation improved by conditional gradients: the assignment that its own linearisation likes best."""
    cost = _cost(a, b, images, order)
    for _ in range(STEPS):
        # what (x, y) costs with all others as they are
        to_images = b[:, images]
        linear = np.stack([(np.abs(to_images - row) ** order).mean(axis=1) for row in a])
        better = linear_sum_assignment(linear)[1]
        found = _cost(a, b, better, order)
        if found >= cost:
            break
        images, cost = better, found
    return images
