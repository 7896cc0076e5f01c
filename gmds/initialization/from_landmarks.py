"""Starts from known points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from geodesics.arrays import Integers
from gmds.initialization.extremities import surface_extremities, trilaterated
from gmds.spectral.sample_maps import SampledPair


def landmarks(ours: Integers, theirs: Integers) -> Callable[[SampledPair], list[Integers]]:
    """A start by trilateration from corresponding vertices (l,) and, if they are few, one more extremity each way."""

    def start(pair: SampledPair) -> list[Integers]:
        starts = [trilaterated(pair, ours, theirs)] if len(ours) > 2 else []
        if len(ours) < 6:
            for a in surface_extremities(pair.source):
                for b in surface_extremities(pair.target):
                    starts.append(trilaterated(pair, np.append(ours, a), np.append(theirs, b)))
        return starts

    return start
