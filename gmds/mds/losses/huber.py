"""Huber's loss."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics.arguments import real_number
from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from gmds.mds.losses.base import SmoothLoss


@dataclass(frozen=True)
class Huber(SmoothLoss):
    r"""The mean of :math:`r^2` where :math:`|r| \le t`, and of :math:`t (2 |r| - t)` beyond: outliers count less.

    Parameters
    ----------
    threshold : float
        :math:`t`, positive, in mean distances.

    Raises
    ------
    ValueError
        When the threshold is not positive.

    References
    ----------
    Huber: Robust estimation of a location parameter (1964).

    See Also
    --------
    LeastSquares, Power, Minimax : Other losses.

    Examples
    --------
    >>> import gmds
    >>> import numpy as np
    >>> round(gmds.Huber(0.1).value(np.array([0.1, -0.2, 0.3])), 4)
    0.03
    """

    threshold: float = 0.1

    def __post_init__(self) -> None:
        if not real_number(self.threshold, "the positive threshold of Huber's loss") > 0:
            raise BadArgument(f"the threshold of Huber's loss must be positive, not {self.threshold}")

    def rho(self, residuals: Floats) -> Floats:
        r""":math:`\min(|r|, t) \, (2 |r| - \min(|r|, t))`."""
        size = np.abs(residuals)
        inner = np.minimum(size, self.threshold)
        return inner * (2 * size - inner)

    def slope(self, residuals: Floats) -> Floats:
        r""":math:`2 r`, held between :math:`-2 t` and :math:`2 t`."""
        return 2 * np.clip(residuals, -self.threshold, self.threshold)

    def curvature(self, residuals: Floats) -> Floats:
        r""":math:`2 \min(1, t / |r|)`, of the parabola that touches the loss at r and lies above it."""
        return 2 * self.threshold / np.maximum(np.abs(residuals), self.threshold)
