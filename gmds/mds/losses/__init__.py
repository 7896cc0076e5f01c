"""One loss a file: `value(residuals)` and `step(jacobian, residuals, radius)`."""

from gmds.mds.losses.base import Loss, SmoothLoss
from gmds.mds.losses.huber import Huber
from gmds.mds.losses.least_squares import LeastSquares
from gmds.mds.losses.minimax import Minimax
from gmds.mds.losses.power import Power

ALL = (LeastSquares, Huber, Power, Minimax)
"""Every loss, each to be made without arguments; the tests of losses run on all of them."""

__all__ = ["ALL", "Huber", "LeastSquares", "Loss", "Minimax", "Power", "SmoothLoss"]
