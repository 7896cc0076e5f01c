"""From many starts to the few distinct sample maps that distort distances least."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from geodesics.arrays import Integers
from geodesics.threads import side_by_side
from gmds.spectral.sample_maps import COARSE, SampledPair

# All set by hand.
FIRST_STEPS = 3  # of refinement, before all but TRIED are dropped
TRIED = 64  # starts that are refined to the end
DISTINCT = 0.12  # of the mean distance: how far apart two maps must be to count as two


def shortlist(
    pair: SampledPair, starts: Sequence[Callable[[SampledPair], list[Integers]]], count: int
) -> list[Integers]:
    """At most `count` sample maps, all apart from each other, those of least stress first."""
    few = pair.coarse
    begun = few.all_refined([images for start in starts for images in start(few)], COARSE[:FIRST_STEPS])
    begun = [pair.of_coarse(begun[i], COARSE[FIRST_STEPS - 1]) for i in _by_stress(few, begun)[:TRIED]]
    done = pair.all_refined(begun, COARSE[FIRST_STEPS:])
    kept: list[Integers] = []
    for i in _by_stress(pair, done):
        if len(kept) < count and all(pair.gap(done[i], other) > DISTINCT for other in kept):
            kept.append(done[i])
    return kept


def _by_stress(pair: SampledPair, maps: list[Integers]) -> Integers:
    return np.argsort(side_by_side(pair.stress, maps), kind="stable")
