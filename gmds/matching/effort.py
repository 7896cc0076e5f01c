"""Whether a map changes the size of parts: where it does not, the metric of space alone is enough."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from gmds.registration.deformable import DeformableMesh

# Heat time, in units of the area, that smooths the logarithm of how much a map enlarges areas, and its standard
# deviation up to which no part is taken to have changed its size. On development pairs (benchmarks/results/notes.md,
# "Effort") it is 0.026 to 0.057 for FAUST, 0.025 to 0.098 for TOSCA and 0.076 to 0.245 where parts were scaled.
GROWTH_TIME = 2e-2
MOST_GROWTH = 0.065


def keeps_sizes(source: DeformableMesh, y: Floats) -> bool:
    """Whether no part of the source changes its size when its vertices go to y (n, 3)."""
    growth = source.log_growth(y, GROWTH_TIME)
    mean = source.areas @ growth
    return bool(np.sqrt(source.areas @ (growth - mean) ** 2) < MOST_GROWTH)
