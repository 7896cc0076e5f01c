"""How much work a pair needs: what the metric of space decides alone, and whether parts keep their sizes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal

# Heat time, in units of the area, that smooths the logarithm of how much a map enlarges areas, and its standard
# deviation up to which no part is taken to have changed its size. On development pairs (benchmarks/results/notes.md,
# "Effort") it is 0.026 to 0.057 for FAUST, 0.025 to 0.098 for TOSCA and 0.076 to 0.245 where parts were scaled.
GROWTH_TIME = 2e-2
MOST_GROWTH = 0.06


def is_isometric(pair: SurfacePair, proposals: Sequence[Proposal]) -> bool:
    """Whether under the likeliest of the proposals no part changes its size: distances in space are then compared."""
    source = pair.simplified[0]
    best = min(proposals, key=lambda one: one.neg_log_likelihood)
    growth = source.log_growth(best.registered.y, GROWTH_TIME)
    mean = source.areas @ growth
    return bool(np.sqrt(source.areas @ (growth - mean) ** 2) < MOST_GROWTH)
