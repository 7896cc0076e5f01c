r"""What the confidence of a map is: a calibrated probability, at one radius and, by proportional odds, at all others.

`Correspondence.confidence` is this probability :math:`p` for `RADIUS`. That a point lies within another radius r has
the odds

.. math:: \frac{p_r}{1 - p_r} = \frac{p}{1 - p} \, e^{a(r)}

with one increasing function a for all maps, `LOG_ODDS` at the radii `RADII` and linear in log r between and beyond
them, fitted with the probability itself by `benchmarks/trust` (`benchmarks/results/trust.md` shows how well both hold).
"""

from __future__ import annotations

import numbers

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Bools, Floats
from geodesics.errors import BadArgument

RADIUS = 0.05  # root areas of the target: the distance at which the protocol stops calling a point well matched
# Radii in root areas, and the logarithm of what odds change by from `RADIUS` to them: fitted (`benchmarks.trust.fit`).
RADII = (0.02, 0.03, 0.05, 0.08, 0.1, 0.15, 0.2, 0.3)
LOG_ODDS = (-2.04, -1.05, 0.0, 1.08, 1.48, 2.07, 2.5, 2.95)
MOST_LOG_ODDS = 700.0  # beyond which the exponential of a double is 0 or infinite: a bound


def confidence_at(confidence: ArrayLike, radius: float) -> Floats:
    """The probability that a point lies within another `radius` of the truth.

    Parameters
    ----------
    confidence : array_like
        Probabilities at `RADIUS`, from 0 to 1; NaN stays NaN.
    radius : float
        In root areas of the target, positive.

    Returns
    -------
    float64 array
        Of the same shape; grows with the radius and with the confidence.

    Raises
    ------
    BadArgument
        When the radius is not a positive number (E604).
    """
    if not isinstance(radius, numbers.Real) or not radius > 0:
        raise BadArgument(f"radius must be a positive number of root areas, not {radius!r:.40}")
    p = np.asarray(confidence, dtype=np.float64)
    factor = np.exp(np.clip(log_odds(radius), -MOST_LOG_ODDS, MOST_LOG_ODDS))
    return np.asarray(p * factor / (1 - p + p * factor), dtype=np.float64)


def log_odds(radius: float) -> float:
    """The a(r) of the formula: linear in log r between the `RADII`, and as the outermost two beyond them."""
    x, at = np.log(RADII), np.log(radius)
    k = int(np.clip(np.searchsorted(x, at) - 1, 0, len(x) - 2))
    slope = (LOG_ODDS[k + 1] - LOG_ODDS[k]) / (x[k + 1] - x[k])
    return float(LOG_ODDS[k] + slope * (at - x[k]))


def not_rated() -> Floats:
    """What stands for the confidence of a map that nobody has rated, until its vertices are counted."""
    return np.empty(0)


def known_confidence(confidence: ArrayLike, valid: ArrayLike) -> Floats:
    """A confidence (n,) as a map keeps it: 0 where not `valid`, NaN everywhere where it is `not_rated`."""
    flags: Bools = np.asarray(valid, dtype=np.bool_).reshape(-1)
    array = np.array(confidence, dtype=np.float64).reshape(-1)
    if len(array) == 0:
        return np.full(len(flags), np.nan)
    if len(array) == len(flags) and not np.isnan(array).all():
        array[~flags] = 0.0
    return array
