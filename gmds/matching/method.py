"""The distance and the loss of a match, looked at before anything is computed with them."""

from __future__ import annotations

from typing import Any

from geodesics.errors import BadArgument
from gmds.mds.losses import Loss, as_loss


def loss_of(distance: Any, loss: Any) -> Loss:
    """The loss, `LeastSquares()` for None; `distance` is a function of a mesh, or None.

    Raises `BadArgument` (E604) when either is something else, as the name of one or a class of losses.
    """
    if distance is not None and not callable(distance):
        raise BadArgument(
            f"distance must be a function that takes a mesh, as geodesics.GeodesicDistance, not {distance!r}"
        )
    return as_loss(loss)
