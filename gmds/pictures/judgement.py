"""How good a map is, as the third view of its picture shows it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from gmds.maps.growth import growth_of
from gmds.maps.point_map import PointMap
from gmds.pictures.colours import nearest_known
from gmds.pictures.scales import SIGNED, range_of


class Judgement(NamedTuple):
    """What the third view shows of a map: what it is called, values (n,), the range, the label of the bar.

    Ranges are those of `gmds.pictures.scales`, so that two pictures, or a picture and a page, can be compared.
    """

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
        return Judgement("error", nearest_known(answer.source, errors), range_of("error"), "error / √area")
    if show == "growth":
        values, signed = growth_of(answer).relative, "growth" in SIGNED
        return Judgement("growth", values, range_of("growth"), "log of the change of length", signed)
    if np.isnan(answer.confidence).all():
        return Judgement("distortion", answer.distortion, range_of("distortion"), "share of lengths")
    return Judgement("doubt", 1 - answer.confidence, range_of("confidence"), "1 less the confidence")
