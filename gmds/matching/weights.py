"""The model of confidence (see `gmds.matching.rating`), as `python -m benchmarks.trust.fit` wrote it."""

from __future__ import annotations

from typing import NamedTuple


class Weight(NamedTuple):
    """Of one sign: what it counts, and the range it is held in."""

    weight: float
    low: float
    high: float


# In the order of the signs.
CONSTANT = 2.668
WEIGHTS = {
    "curvature_far": Weight(-0.3462, -3.861, -0.00264),
    "curvature_near": Weight(-0.2614, -4.02, 0.237),
    "spectral": Weight(-0.2637, -4.212, -0.09548),
    "stress": Weight(-0.4874, -5.318, -0.9676),
    "normals": Weight(-0.4416, -9.21, -1.947),
    "folds": Weight(0.1887, -9.21, -0.4197),
    "uneven_growth": Weight(-0.7109, 0.0003563, 0.6715),
    "gap": Weight(0.2911, -7.714, -3.517),
    "strain": Weight(-0.6502, -2.363, 0.07481),
    "laid": Weight(-26.6, 0, 0.0425),
    "folded": Weight(4.057, 0.0004691, 0.2092),
    "rival": Weight(-2.186, 0.0003355, 0.5596),
    "whole_energy": Weight(-0.6129, -2.207, -0.1774),
    "whole_curvature": Weight(-0.8136, -4.386, -0.3673),
    "whole_curvature_back": Weight(-0.4015, -3.614, -0.3592),
    "simplified_curvature": Weight(0.3184, -2.216, -0.1799),
    "simplified_misfit": Weight(1.532, -4.54, -3.636),
}
