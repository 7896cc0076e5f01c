"""Whether a map changes the size of parts, and whether it reaches all of the target: then space alone is enough."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from gmds.registration.deformable import DeformableMesh
from gmds.registration.register import Registered

# Heat time, in units of the area, that smooths the logarithm of how much a map enlarges areas, and its standard
# deviation up to which no part is taken to have changed its size. On development pairs (benchmarks/results/notes.md,
# "Effort") it is 0.026 to 0.057 for FAUST, 0.025 to 0.098 for TOSCA and 0.076 to 0.245 where parts were scaled.
GROWTH_TIME = 2e-2
MOST_GROWTH = 0.065

# Heat time, in units of the area, that smooths the squares of what a registered surface is off the other, and root
# areas of it up to which nothing is left off: the larger of both ways is 0.041 to 0.051 where ears, nose or legs were
# exchanged, and 0.013 to 0.030 for 23 of 31 right maps (the same section).
GAP_TIME = 3e-3
MOST_GAP = 0.03


def keeps_sizes(source: DeformableMesh, y: Floats) -> bool:
    """Whether no part of the source changes its size when its vertices go to y (n, 3)."""
    growth = source.log_growth(y, GROWTH_TIME)
    mean = source.areas @ growth
    return bool(np.sqrt(source.areas @ (growth - mean) ** 2) < MOST_GROWTH)


def largest_gap(source: DeformableMesh, one: Registered) -> float:
    """How far off the target the source is, in root areas, in the region where it is farthest off."""
    squares = ((one.points.positions - one.y) ** 2).sum(axis=1)
    return float(np.sqrt(max(source.laplacian.heat_step(GAP_TIME)(source.areas * squares).max(), 0.0)))
