"""Starts from known points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from gmds.initialization.extremities import surface_extremities, trilaterated
from gmds.upsampling import SampledPair

Index = NDArray[np.int64]


def landmarks(ours: Index, theirs: Index) -> Callable[[SampledPair], list[Index]]:
    """A start by trilateration from corresponding vertices (l,) and, if they are few, one more extremity each way."""

    def start(pair: SampledPair) -> list[Index]:
        starts = [trilaterated(pair, ours, theirs)] if len(ours) > 2 else []
        if len(ours) < 6:
            for a in surface_extremities(pair.source):
                for b in surface_extremities(pair.target):
                    starts.append(trilaterated(pair, np.append(ours, a), np.append(theirs, b)))
        return starts

    return start
