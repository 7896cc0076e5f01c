"""The model of confidence (see `gmds.matching.rating`), as `python -m benchmarks.trust.fit` wrote it."""

from __future__ import annotations

from typing import NamedTuple


class Weight(NamedTuple):
    """Of one sign: what it counts, and the range it is held in."""

    weight: float
    low: float
    high: float


# In the order of the signs.
CONSTANT = 3.251
WEIGHTS = {
    "curvature_far": Weight(-0.3781, -3.85, 0.007881),
    "curvature_near": Weight(-0.2681, -4.009, 0.2364),
    "spectral": Weight(-0.2447, -4.149, -0.06074),
    "stress": Weight(-0.4427, -5.355, -0.8995),
    "normals": Weight(-0.4296, -9.21, -2.216),
    "folds": Weight(0.1908, -9.21, -0.4584),
    "uneven_growth": Weight(-0.9161, 0.0003712, 0.6545),
    "gap": Weight(0.2817, -7.711, -3.717),
    "strain": Weight(-0.7025, -2.665, 0.09728),
    "laid": Weight(-23.85, 0, 0.04293),
    "folded": Weight(2.97, 0.0004691, 0.2092),
    "rival": Weight(-2.191, 0.0003355, 0.5891),
    "whole_energy": Weight(-0.5586, -2.207, -0.1774),
    "whole_curvature": Weight(-0.7875, -4.396, -0.3634),
    "whole_curvature_back": Weight(-0.409, -3.628, -0.3476),
    "simplified_curvature": Weight(0.381, -2.216, -0.1673),
    "simplified_misfit": Weight(1.601, -4.54, -3.636),
}
