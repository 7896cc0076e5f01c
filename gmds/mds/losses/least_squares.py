"""Least squares."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics.arrays import Floats
from gmds.mds.losses.base import SmoothLoss


@dataclass(frozen=True)
class LeastSquares(SmoothLoss):
    """The mean of :math:`r^2`: the generalised stress with exponent 2.

    References
    ----------
    Bronstein, Bronstein, Kimmel: Generalized multidimensional scaling (2006).

    See Also
    --------
    Huber, Power, Minimax : Other losses.

    Examples
    --------
    >>> import gmds
    >>> import numpy as np
    >>> round(gmds.LeastSquares().value(np.array([0.1, -0.2, 0.3])), 4)
    0.0467
    """

    def rho(self, residuals: Floats) -> Floats:
        r""":math:`\rho(r) = r^2`."""
        return residuals**2

    def slope(self, residuals: Floats) -> Floats:
        """:math:`2 r`."""
        return 2 * residuals

    def curvature(self, residuals: Floats) -> Floats:
        """:math:`2`."""
        return np.full_like(residuals, 2.0)
