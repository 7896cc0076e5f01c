"""Powers of the residual."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics.arguments import real_number
from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from gmds.mds.losses.base import SmoothLoss


@dataclass(frozen=True)
class Power(SmoothLoss):
    """The mean of :math:`(r^2 + s^2)^{p/2} - s^p`: the generalised stress with exponent p, rounded at zero.

    p = 1 is the mean absolute residual; a large p approaches the maximum.

    Parameters
    ----------
    exponent : float
        :math:`p`, at least 1.
    rounding : float
        :math:`s`, positive, in mean distances.

    Raises
    ------
    ValueError
        When the exponent is below 1 or not finite, or the rounding is not positive.

    See Also
    --------
    LeastSquares, Huber, Minimax : Other losses.

    Examples
    --------
    >>> import gmds
    >>> import numpy as np
    >>> round(gmds.Power(1.0).value(np.array([0.1, -0.2, 0.3])), 2)  # about the mean of the absolute values
    0.2
    """

    exponent: float = 4.0
    rounding: float = 1e-3

    def __post_init__(self) -> None:
        numbers = real_number(self.exponent, "exponent"), real_number(self.rounding, "rounding")
        if not (numbers[0] >= 1 and numbers[1] > 0):
            raise BadArgument(f"{self} needs an exponent of at least 1 and a positive rounding")

    def rho(self, residuals: Floats) -> Floats:
        """:math:`(r^2 + s^2)^{p/2} - s^p`."""
        return np.hypot(residuals, self.rounding) ** self.exponent - self.rounding**self.exponent

    def slope(self, residuals: Floats) -> Floats:
        r""":math:`p \, r \, (r^2 + s^2)^{p/2 - 1}`."""
        return self.exponent * residuals * np.hypot(residuals, self.rounding) ** (self.exponent - 2)

    def curvature(self, residuals: Floats) -> Floats:
        r""":math:`p \max(1, p - 1) (r^2 + s^2)^{p/2 - 1}`, at least the second derivative."""
        factor = self.exponent * max(1.0, self.exponent - 1)
        return factor * np.hypot(residuals, self.rounding) ** (self.exponent - 2)
