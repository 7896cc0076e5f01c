"""Bounds of the Gromov-Hausdorff distance, certified for the samples and for the surfaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arguments import real_numbers
from geodesics.arrays import Floats, Integers
from geodesics.errors import BadArgument

ASYMMETRY = 1e-6  # of the largest distance, above which a matrix is not symmetric: a bound, far above rounding
LARGEST = 1e100  # distance, whose square and sums of it stay within float64: a bound
ROUNDS = 20  # in which points look for better partners, at the most: a bound, descents of 100 points take about five


@dataclass(frozen=True)
class Bounds:
    """A lower and an upper bound of a distance between shapes, in units of the distances."""

    lower: float
    upper: float


def gromov_hausdorff_bounds(
    first: ArrayLike, second: ArrayLike, *, start: ArrayLike | None = None, covering: tuple[float, float] = (0.0, 0.0)
) -> Bounds:
    r"""Bounds of the Gromov-Hausdorff distance of two sets of samples, or of the surfaces they cover (sec. 5).

    .. math:: d_{GH} = \frac12 \inf_R \max_{(x,y), (x',y') \in R} |d_S(x, x') - d_Q(y, y')|

    over all correspondences R, in which every sample of either set has a partner. Below: if y is a partner of x, each
    distance from x is, within the distortion of R, a distance from y and the other way round, so

    .. math:: d_{GH} \ge \frac12 \max_x \min_y \, d_H \big( \{ d_S(x, \cdot) \}, \{ d_Q(y, \cdot) \} \big)

    with the Hausdorff distance of sets of numbers, and likewise from y; half the difference of diameters is less.
    Above: the distortion of a correspondence, found by descent from assigned sets of distances.

    Parameters
    ----------
    first, second : array_like of shape (p, p) and (q, q)
        Distances among samples of each surface, as `geodesics.distance_matrix` gives them.
    start : array_like of int, shape (p,), optional
        Where to begin the descent: the partner of each sample of the first.
    covering : two floats
        How far any point of either surface is from its nearest sample; the bounds then hold for the surfaces.

    Returns
    -------
    Bounds
        `lower` <= d_GH <= `upper`.

    Raises
    ------
    ValueError
        For matrices that are not square, finite and symmetric, with zeros on the diagonal; for a start or a covering
        that cannot be.

    References
    ----------
    Memoli, Sapiro: A theoretical and computational framework for isometry invariant recognition of point cloud data
    (2005); Bronstein, Bronstein, Kimmel: Efficient computation of isometry-invariant distances between surfaces (2006);
    Memoli: Some properties of Gromov-Hausdorff distances (2012).

    See Also
    --------
    gromov_wasserstein_bounds : With areas, and means in place of maxima.
    dissimilarity : The mean distortion of the best embedding, in the scale-invariant metric.

    Examples
    --------
    >>> import gmds
    >>> one = [[0, 1, 2], [1, 0, 1], [2, 1, 0]]  # distances among three points
    >>> other = [[0, 1, 1], [1, 0, 1], [1, 1, 0]]
    >>> bounds = gmds.gromov_hausdorff_bounds(one, other)
    >>> bool(0 < bounds.lower <= bounds.upper)
    True
    """
    a, b = finite_square(first), finite_square(second)
    gaps = local_gaps(a, b)
    lower = 0.5 * max(float(gaps.min(axis=1).max()), float(gaps.min(axis=0).max()))
    there = gaps.argmin(axis=1) if start is None else partners_given(start, len(a), len(b))
    slack = _slack(covering)
    upper = 0.5 * _least_distortion(a, b, there, gaps.argmin(axis=0) if start is None else None)
    return Bounds(max(lower - slack, 0.0), upper + slack)


def finite_square(distances: ArrayLike) -> Floats:
    """A matrix of distances (p, p); `BadArgument` (E604) where it is not."""
    d = real_numbers(distances, "distances")
    if d.ndim != 2 or d.shape[0] != d.shape[1] or len(d) == 0:
        raise BadArgument(f"distances must be a square matrix, not of shape {d.shape}")
    if not np.isfinite(d).all():
        raise BadArgument("distances must be finite: take samples of one component, which can reach each other")
    if (d < 0).any() or d.max() > LARGEST:
        raise BadArgument(f"distances must be from 0 to {LARGEST:g}, not {d.min():.3g} to {d.max():.3g}")
    if np.abs(d - d.T).max() > ASYMMETRY * d.max() or np.diagonal(d).any():
        raise BadArgument("distances must be symmetric, and 0 from a sample to itself, as of geodesics.distance_matrix")
    return d


def partners_given(start: ArrayLike, count: int, others: int) -> Integers:
    """The partner of each of `count` samples among `others` (count,); `BadArgument` (E604) where it is not that."""
    given = real_numbers(start, "start")
    if given.shape != (count,) or not np.isin(given, np.arange(others)).all():
        raise BadArgument(f"start must give each of {count} samples a partner, a whole number from 0 to {others - 1}")
    return given.astype(np.int64)


def _slack(covering: tuple[float, float]) -> float:
    reach = real_numbers(covering, "covering")
    if reach.shape != (2,) or not np.isfinite(reach).all() or (reach < 0).any():
        raise BadArgument(f"covering must be two distances, finite and not negative, not {covering!r:.60}")
    return float(reach.sum())


def local_gaps(a: Floats, b: Floats) -> Floats:
    """Hausdorff distances (p, q) between the sets of distances from x, rows of a (p, p), and from y, rows of b."""
    ours, theirs = np.sort(a, axis=1), np.sort(b, axis=1)
    return np.array([[max(_beyond(x, y), _beyond(y, x)) for y in theirs] for x in ours])


def _beyond(values: Floats, others: Floats) -> float:
    """How far the farthest value is from its nearest other; both ascending."""
    place = np.searchsorted(others, values)
    above = np.abs(others[np.minimum(place, len(others) - 1)] - values)
    below = np.abs(values - others[np.maximum(place - 1, 0)])
    return float(np.minimum(above, below).max())


def _least_distortion(a: Floats, b: Floats, there: Integers, back: Integers | None) -> float:
    """The distortion of a correspondence of maps there (p,) and back (q,), each lowered on its own and by the other."""
    there = _descended(a, b, there)
    back = _descended(b, a, _partners(a, b, there) if back is None else back)
    both = [(there, back), (there, _partners(a, b, there)), (_partners(b, a, back), back)]
    here, others = np.arange(len(a)), np.arange(len(b))
    return min(distortion(a, b, np.r_[here, g], np.r_[f, others]) for f, g in both)


def _partners(a: Floats, b: Floats, images: Integers) -> Integers:
    """For each y of the second (q,) the x whose distances a[x] are nearest to those of y to the images (p,)."""
    return np.array([np.abs(a - row[images]).max(axis=1).argmin() for row in b], dtype=np.int64)


def distortion(a: Floats, b: Floats, ours: Integers, theirs: Integers) -> float:
    """max |d(x, x') - d(y, y')| over the pairs (ours, theirs) of a relation."""
    return float(np.abs(a[np.ix_(ours, ours)] - b[np.ix_(theirs, theirs)]).max())


def _descended(a: Floats, b: Floats, images: Integers) -> Integers:
    """Images (p,) after each point in turn went where its own largest residual is least."""
    places = images.copy()
    for _ in range(ROUNDS):
        moved = False
        for x in range(len(a)):
            residuals = np.abs(b[:, places] - a[x])
            residuals[:, x] = 0
            cost = residuals.max(axis=1)
            y = int(cost.argmin())
            if cost[y] < cost[places[x]]:
                places[x], moved = y, True
        if not moved:
            break
    return places
