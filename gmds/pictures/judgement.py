"""How good a map is, as the third view of its picture shows it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from gmds.maps.growth import growth_of
from gmds.maps.point_map import PointMap
from gmds.pictures.colours import nearest_known, shown_range, symmetric_reach


def judgement(answer: PointMap, errors: ArrayLike | None, show: str) -> tuple[str, Floats, tuple[float, float]]:
    """What the third view shows of the map, what it is called, and the range."""
    if show not in ("doubt", "growth"):
        raise BadArgument(f"a picture shows doubt or growth, not {show!r}")
    if errors is not None:
        values = nearest_known(answer.source, errors)
        return "error", values, shown_range(values)
    if show == "growth":
        values = growth_of(answer).relative
        reach = symmetric_reach(values)
        return "growth: log of length", values, (-reach, reach)
    if np.isnan(answer.confidence).all():
        return "distortion", answer.distortion, shown_range(answer.distortion)
    return "doubt", 1 - answer.confidence, (0.0, 1.0)
