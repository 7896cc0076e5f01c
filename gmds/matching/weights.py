"""The model of confidence (see `gmds.matching.rating`), as `python -m benchmarks.trust.fit` wrote it."""

from __future__ import annotations

from typing import NamedTuple


class Weight(NamedTuple):
    """Of one sign: what it counts, and the range it is held in."""

    weight: float
    low: float
    high: float


# In the order of the signs.
CONSTANT = 1.615
WEIGHTS = {
    "curvature_far": Weight(-0.3344, -3.859, 0.03171),
    "curvature_near": Weight(-0.2968, -4.028, 0.2591),
    "spectral": Weight(-0.2392, -4.208, -0.01813),
    "stress": Weight(-0.3657, -5.38, -0.7992),
    "normals": Weight(-0.4269, -9.21, -1.946),
    "folds": Weight(0.1988, -9.21, -0.4062),
    "uneven_growth": Weight(-0.6672, 0.0003625, 0.6645),
    "gap": Weight(0.2648, -7.711, -3.616),
    "strain": Weight(-0.6682, -2.677, 0.1338),
    "laid": Weight(-20.9, 0, 0.04623),
    "folded": Weight(3.089, 0.0004499, 0.2092),
    "rival": Weight(-1.972, 0.0003355, 0.6241),
    "whole_energy": Weight(-0.4808, -2.145, -0.1774),
    "whole_curvature": Weight(-0.8568, -4.396, -0.3074),
    "whole_curvature_back": Weight(-0.4154, -3.628, -0.2885),
    "simplified_curvature": Weight(0.609, -2.132, -0.2243),
    "simplified_misfit": Weight(1.125, -4.54, -3.629),
}
