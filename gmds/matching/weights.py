"""The model of confidence (see `gmds.matching.rating`), as `python -m benchmarks.trust.fit` wrote it."""

from __future__ import annotations

from typing import NamedTuple


class Weight(NamedTuple):
    """Of one sign: what it counts, and the range it is held in."""

    weight: float
    low: float
    high: float


# In the order of the signs.
CONSTANT = 1.915
WEIGHTS = {
    "curvature_far": Weight(-0.45, -3.911, 0.021),
    "curvature_near": Weight(-0.4547, -4.13, 0.2668),
    "spectral": Weight(-0.1448, -4.164, 0.07298),
    "stress": Weight(-0.1686, -5.39, -0.8135),
    "normals": Weight(-0.3443, -9.21, -2.157),
    "folds": Weight(0.1401, -9.21, -0.4419),
    "uneven_growth": Weight(-0.5576, 0.0003753, 0.6307),
    "gap": Weight(0.3105, -7.757, -3.56),
    "strain": Weight(-0.9816, -2.319, 0.1436),
    "folded": Weight(6.764, 0.0004566, 0.1703),
    "rival": Weight(-2.609, 0.0003355, 0.8154),
    "whole_energy": Weight(-0.3522, -2.175, -0.1667),
    "whole_curvature": Weight(-0.8111, -4.348, -0.3077),
    "whole_curvature_back": Weight(-0.6011, -3.549, -0.3234),
    "simplified_curvature": Weight(1.236, -2.069, -0.2201),
    "simplified_misfit": Weight(0.9348, -4.547, -3.609),
}
