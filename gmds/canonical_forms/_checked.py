"""What all scalings ask of their input."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arguments import real_numbers
from geodesics.arrays import Floats
from geodesics.errors import BadArgument

ASYMMETRY = 1e-6  # of the largest distance, above which a matrix is not symmetric: a bound, far above rounding


def square(distances: ArrayLike) -> Floats:
    """Distances as (p, p), symmetric to the last bit; `BadArgument` (E604) where they are not (p, p) or not finite."""
    d = real_numbers(distances, "distances")
    if d.ndim != 2 or d.shape[0] != d.shape[1] or len(d) < 2:
        raise BadArgument(f"distances must be a square matrix of two points at least, not of shape {d.shape}")
    if not np.isfinite(d).all() or (d < 0).any():
        raise BadArgument("distances must be finite and not negative: points that cannot reach each other have no form")
    if np.abs(d - d.T).max() > ASYMMETRY * d.max():
        raise BadArgument("distances must be symmetric; take the mean with the transpose, or geodesics.distance_matrix")
    return 0.5 * (d + d.T)


def known_weights(weights: ArrayLike | None, count: int) -> Floats:
    """Weights (p,) that sum to 1, equal ones for None."""
    if weights is None:
        return np.full(count, 1 / count)
    w = real_numbers(weights, "weights")
    if w.shape != (count,) or not np.isfinite(w).all() or not (w > 0).all():
        raise BadArgument(f"weights must be {count} positive numbers, one for each point")
    return w / w.sum()
