"""One loss a file: `value(residuals)` and `step(jacobian, residuals, radius)`."""

from typing import Any

from geodesics.errors import BadArgument
from gmds.mds.losses.base import Loss, SmoothLoss
from gmds.mds.losses.huber import Huber
from gmds.mds.losses.least_squares import LeastSquares
from gmds.mds.losses.minimax import Minimax
from gmds.mds.losses.power import Power

ALL = (LeastSquares, Huber, Power, Minimax)
"""Every loss, each to be made without arguments; the tests of losses run on all of them."""


def as_loss(loss: Any) -> Loss:
    """The loss that it is, `LeastSquares()` for None; `BadArgument` (E604) for a name, a class, or something else."""
    if loss is None:
        return LeastSquares()
    if isinstance(loss, type) or not all(callable(getattr(loss, name, None)) for name in ("value", "step")):
        there = ", ".join(f"{one.__name__}()" for one in ALL)
        raise BadArgument(f"loss must be one of {there} of gmds.mds.losses, or another object like them, not {loss!r}")
    return loss  # type: ignore[no-any-return]


__all__ = ["ALL", "Huber", "LeastSquares", "Loss", "Minimax", "Power", "SmoothLoss"]
