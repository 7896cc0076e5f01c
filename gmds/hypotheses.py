"""From many starts to the few distinct sample maps that distort distances least."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from gmds.upsampling import COARSE, SampledPair

Index = NDArray[np.int64]

TRIED = 64  # starts that are refined to the end
DISTINCT = 0.12  # of the mean distance: how far apart two maps must be to count as two
EARLY = 3  # steps of refinement before the rest is dropped
THIN = 6  # steps for which few samples do


def hypotheses(
    pair: SampledPair, starts: Sequence[Callable[[SampledPair], list[Index]]], count: int, *, thinned: bool = False
) -> list[Index]:
    """At most `count` sample maps, all apart from each other, those of least stress first.

    `thinned`: whether they begin as maps of fewer samples, which takes half as long.
    """
    few, last = (pair.thinned, THIN) if thinned else (pair, EARLY)
    begun = [few.refined(images, COARSE[:EARLY]) for start in starts for images in start(few)]
    begun = [begun[i] for i in _by_stress(few, begun)[:TRIED]]
    begun = [few.refined(images, COARSE[EARLY:last]) for images in begun]
    done = [pair.refined(images, COARSE[last:], few) for images in begun]
    kept: list[Index] = []
    for i in _by_stress(pair, done):
        if len(kept) < count and all(pair.gap(done[i], other) > DISTINCT for other in kept):
            kept.append(done[i])
    return kept


def _by_stress(pair: SampledPair, maps: list[Index]) -> Index:
    return np.argsort([pair.stress(images) for images in maps], kind="stable")
