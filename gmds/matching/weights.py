"""The model of confidence (see `gmds.matching.rating`), as `python -m benchmarks.trust.fit` wrote it."""

from __future__ import annotations

from typing import NamedTuple


class Weight(NamedTuple):
    """Of one sign: what it counts, and the range it is held in."""

    weight: float
    low: float
    high: float


# In the order of the signs.
CONSTANT = 2.665
WEIGHTS = {
    "curvature_far": Weight(-0.3746, -3.818, 0.02311),
    "curvature_near": Weight(-0.2756, -3.982, 0.2489),
    "spectral": Weight(-0.2596, -4.162, -0.04737),
    "stress": Weight(-0.4156, -5.358, -0.8649),
    "normals": Weight(-0.407, -9.21, -2.028),
    "folds": Weight(0.1911, -9.21, -0.4306),
    "uneven_growth": Weight(-0.6799, 0.000363, 0.6489),
    "gap": Weight(0.2591, -7.682, -3.64),
    "strain": Weight(-0.6545, -2.67, 0.1294),
    "laid": Weight(-22.6, 0, 0.04469),
    "folded": Weight(2.705, 0.0004499, 0.2092),
    "rival": Weight(-1.898, 0.0003355, 0.6241),
    "whole_energy": Weight(-0.4191, -2.145, -0.1774),
    "whole_curvature": Weight(-0.8466, -4.396, -0.3074),
    "whole_curvature_back": Weight(-0.3976, -3.628, -0.2885),
    "simplified_curvature": Weight(0.4435, -2.216, -0.2243),
    "simplified_misfit": Weight(1.419, -4.54, -3.636),
}
