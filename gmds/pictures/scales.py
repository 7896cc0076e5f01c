"""Where the scales of colours end by which a map is judged: the same in every picture and on every page."""

from __future__ import annotations

# conventions: the bound of the protocol for errors over the root of the area, 1 is certainty, 0.69 twice as long
TOPS = {"confidence": 1.0, "distortion": 0.5, "growth": 0.69, "error": 0.25}
FINE = {"error": 0.1}  # where scales may end as well: the other bound of the protocol, for maps that are good
SIGNED = ("growth",)  # scales that begin as far below 0 as they end above


def range_of(key: str) -> tuple[float, float]:
    """From where to where the scale goes by which this is shown."""
    return (-TOPS[key] if key in SIGNED else 0.0), TOPS[key]
