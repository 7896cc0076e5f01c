"""Least-squares scaling by majorisation: every step lowers the stress."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from geodesics.euclidean import euclidean_distances
from gmds.canonical_forms._checked import known_weights, square
from gmds.canonical_forms.classical import classical_scaling


def smacof(
    distances: ArrayLike,
    dimension: int,
    weights: ArrayLike | None = None,
    *,
    start: ArrayLike | None = None,
    max_iterations: int = 300,
    tolerance: float = 1e-6,
) -> Floats:
    r"""Points that have given distances in the least-squares sense, by majorisation (Guttman transforms).

    .. math:: \sigma(X) = \sum_{i,j} w_i w_j \, (d_{ij} - |x_i - x_j|)^2, \qquad
              x_i \leftarrow \sum_j w_j \Big( x_j + d_{ij} \frac{x_i - x_j}{|x_i - x_j|} \Big)

    With weights that sum to 1 the transform of all points at once is this, up to a translation. It never raises the
    stress :math:`\sigma`.

    Parameters
    ----------
    distances : array_like of shape (p, p)
        Symmetric and finite.
    dimension : int
        m, at least 1.
    weights : array_like of shape (p,), optional
        How much each point counts, positive; equal unless given.
    start : array_like of shape (p, m), optional
        Where to begin; by classical scaling unless given.
    max_iterations : int
        Steps, at the most.
    tolerance : float
        Share of the stress by which a step has to lower it, or it is the last.

    Returns
    -------
    array of shape (p, m)
        Centred points.

    Raises
    ------
    ValueError
        As `classical_scaling`, and for a start of another shape.

    References
    ----------
    De Leeuw: Applications of convex analysis to multidimensional scaling (1977); Borg, Groenen: Modern Multidimensional
    Scaling (2005); Elad, Kimmel: On bending invariant signatures for surfaces (2003), where its points are the
    canonical form of a surface.

    See Also
    --------
    canonical_form : Of a whole surface.
    classical_scaling : Squared distances instead.
    """
    d = square(distances)
    w = known_weights(weights, len(d))
    x = classical_scaling(d, dimension, w) if start is None else np.array(start, dtype=np.float64)
    if x.shape != (len(d), dimension):
        raise BadArgument(f"start must be {len(d)} points in {dimension} dimensions, not of shape {x.shape}")
    between = euclidean_distances(x, x)
    stress = stress_of(d, between, w)
    for _ in range(max_iterations):
        x = guttman(x, d, between, w)
        between, before = euclidean_distances(x, x), stress
        stress = stress_of(d, between, w)
        if before - stress <= tolerance * before:
            break
    return x


def guttman(x: Floats, d: Floats, between: Floats, w: Floats) -> Floats:
    """The Guttman transform of points x (p, m) at distances `between`, centred."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(between > 0, d / between, 0.0) * w
    moved = ratio.sum(axis=1)[:, None] * x - ratio @ x
    return np.asarray(moved - w @ moved, dtype=np.float64)


def stress_of(d: Floats, between: Floats, w: Floats) -> float:
    """The sum of w_i w_j (d_ij - |x_i - x_j|)^2."""
    return float(w @ (d - between) ** 2 @ w)
