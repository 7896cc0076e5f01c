"""The distance and the loss of a match, looked at before anything is computed with them."""

from __future__ import annotations

from typing import Any

from geodesics.errors import BadArgument
from gmds.mds.losses import ALL, LeastSquares, Loss


def loss_of(distance: Any, loss: Any) -> Loss:
    """The loss, `LeastSquares()` for None; `distance` is a function of a mesh, or None.

    Raises `BadArgument` (E604) when either is something else, as the name of one or a class of losses.
    """
    if distance is not None and not callable(distance):
        raise BadArgument(
            f"distance must be a function that takes a mesh, as geodesics.GeodesicDistance, not {distance!r}"
        )
    if loss is None:
        return LeastSquares()
    if isinstance(loss, type) or not all(callable(getattr(loss, name, None)) for name in ("value", "step")):
        there = ", ".join(f"{one.__name__}()" for one in ALL)
        raise BadArgument(f"loss must be one of {there} of gmds.mds.losses, or another object like them, not {loss!r}")
    found: Loss = loss
    return found
