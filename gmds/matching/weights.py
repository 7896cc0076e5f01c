"""The model of confidence (see `gmds.matching.rating`), as `python -m benchmarks.trust.fit` wrote it."""

from __future__ import annotations

from typing import NamedTuple


class Weight(NamedTuple):
    """Of one sign: what it counts, and the range it is held in."""

    weight: float
    low: float
    high: float


# In the order of the signs.
CONSTANT = 4.415
WEIGHTS = {
    "curvature_far": Weight(-0.4524, -3.85, 0.007881),
    "curvature_near": Weight(-0.2004, -4.028, 0.2364),
    "spectral": Weight(-0.2715, -4.149, -0.06074),
    "stress": Weight(-0.3648, -5.355, -0.8987),
    "normals": Weight(-0.3587, -9.21, -2.211),
    "folds": Weight(0.1697, -9.21, -0.4454),
    "uneven_growth": Weight(-1.359, 0.0003952, 0.6545),
    "gap": Weight(0.322, -7.712, -3.717),
    "strain": Weight(-0.7544, -2.665, 0.09728),
    "laid": Weight(-25.62, 0, 0.04293),
    "folded": Weight(1.736, 0.0004691, 0.2092),
    "rival": Weight(-1.654, 0.0003355, 0.5891),
    "whole_energy": Weight(-0.5647, -2.207, -0.1774),
    "whole_curvature": Weight(-0.8256, -4.396, -0.3634),
    "whole_curvature_back": Weight(-0.4037, -3.628, -0.3476),
    "simplified_curvature": Weight(0.3737, -2.216, -0.1673),
    "simplified_misfit": Weight(1.699, -4.54, -3.636),
}
