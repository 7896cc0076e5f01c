"""How good a map is, as the third view of its picture shows it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from gmds.maps.growth import growth_of
from gmds.maps.point_map import PointMap
from gmds.pictures.colours import nearest_known, shown_range, symmetric_reach


class Judgement(NamedTuple):
    """What the third view shows of a map: what it is called, values (n,), the range, the label of the bar."""

    caption: str
    values: Floats
    limits: tuple[float, float]
    label: str
    signed: bool = False


def judgement(answer: PointMap, errors: ArrayLike | None, show: str) -> Judgement:
    """What the third view shows of the map."""
    if show not in ("doubt", "growth"):
        raise BadArgument(f"a picture shows doubt or growth, not {show!r}")
    if errors is not None:
        values = nearest_known(answer.source, errors)
        return Judgement("error", values, shown_range(values), "error / √area")
    if show == "growth":
        values = growth_of(answer).relative
        reach = symmetric_reach(values)
        return Judgement("growth", values, (-reach, reach), "log of the change of length", signed=True)
    if np.isnan(answer.confidence).all():
        return Judgement("distortion", answer.distortion, shown_range(answer.distortion), "share of lengths")
    return Judgement("doubt", 1 - answer.confidence, (0.0, 1.0), "1 less the confidence")
