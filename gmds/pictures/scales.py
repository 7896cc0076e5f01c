"""Where the scales of colours end by which a map is judged: the same in every picture and on every page."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats

# conventions: the bound of the protocol for errors over the root of the area, 1 is certainty, 0.69 twice as long
TOPS = {"confidence": 1.0, "distortion": 0.5, "growth": 0.69, "error": 0.25}
FINE = {"error": 0.1}  # where scales may end as well: the other bound of the protocol, for maps that are good
SIGNED = ("growth",)  # scales that begin as far below 0 as they end above
ROUNDING = 1e-4  # of a scale: what is above its end by less is no more; as pages have it


def range_of(key: str) -> tuple[float, float]:
    """From where to where the scale goes by which this is shown."""
    return (-TOPS[key] if key in SIGNED else 0.0), TOPS[key]


def beyond(values: Floats, limits: tuple[float, float]) -> tuple[bool, bool]:
    """Whether any of the values that are known is below a scale, and whether any is above it, by more than rounding."""
    finite, (low, high) = values[np.isfinite(values)], limits
    slack = ROUNDING * (high - low)
    return bool((finite < low - slack).any()), bool((finite > high + slack).any())
