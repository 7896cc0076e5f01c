"""Proposals put together: the likeliest, and in one region after another what a less likely one has there.

Of many maps one has the neck right and another the legs, and none both. Where another map leads elsewhere than the
likeliest, connected region by connected region, the simplified source is sent where the other has it, and registered
anew; what is likelier replaces the likeliest, until nothing is (the crossover of genetic algorithms, which ENIGMA does
with maps of landmarks: Edelstein, Ezuz, Ben-Chen 2020; here nothing is random). What none has, a head the right way
round, may come of a region that is laid on the target anew (`gmds.matching.realignment`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from geodesics.arrays import Bools, Floats
from geodesics.threads import side_by_side
from geodesics.topology.edges import components, edges
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal, cheapest
from gmds.matching.realignment import realigned
from gmds.registration.deformable import DeformableMesh
from gmds.registration.register import Registered, register, settled
from gmds.registration.settings import COARSE, SIMPLIFIED, TO_IMAGES

# Root areas between where two maps lead, smoothed over the surface in this heat time, from which they differ there:
# 0.07 did no better on development pairs (benchmarks/results/notes.md, "Recombination"). Shares of the area that a
# region has, rounds, and how many maps of each are registered to the end, and the way back: set by hand.
APART = 0.1
SMOOTHING_TIME = 2e-3
SHARES = (0.01, 0.5)
MOST_ROUNDS = 4
MOST_SETTLED = 6
MOST_RETURNED = 3
LEAST_GAIN = 0.1  # of log-likelihood in a round, as of annealing: less makes maps better as often as worse (there)
HALF = 0.5  # of a region comes to where another was, if they are exchanged: a bound
SAME = 0.02  # root areas, root mean square, below which two maps are put together alike: a bound


def recombined(pair: SurfacePair, maps: Sequence[Proposal], more: Sequence[Registered] = ()) -> list[Proposal]:
    """What the likeliest of some maps became, step by step, with regions of the others; none if nothing is likelier.

    Regions come from `more` as well: sources that need not have been registered the way back.
    """
    source, target = pair.simplified
    begin, settle = SIMPLIFIED.with_stages(TO_IMAGES), SIMPLIFIED.with_stages(COARSE)
    best, *rest = sorted(maps, key=_unlikeliness)
    others = [*(one.registered for one in rest), *more]
    found: list[Proposal] = []
    tried: list[Floats] = []
    for _ in range(MOST_ROUNDS):
        y = best.registered.y
        hybrids = [*_hybrids(source, y, [one.y for one in others]), *realigned(source, target, y)]
        places = _untried(source, hybrids, tried)
        begun = side_by_side(lambda place: register(source, target, place, begin), places)
        there = side_by_side(lambda one: settled(source, target, one.y, settle), cheapest(begun)[:MOST_SETTLED])
        back = side_by_side(lambda one: Proposal.completed(pair, one, SIMPLIFIED), cheapest(there)[:MOST_RETURNED])
        likeliest = min(back, key=_unlikeliness, default=best)
        if likeliest.neg_log_likelihood > best.neg_log_likelihood - LEAST_GAIN:
            break
        others.append(best.registered)
        best = replace(likeliest, improved=True)
        found.append(best)
    return found


def regions(source: DeformableMesh, one: Floats, other: Floats) -> list[Bools]:
    """Connected regions (n,) of the source, neither tiny nor most of it, that two maps to y (n, 3) lead apart."""
    apart = source.laplacian.heat_step(SMOOTHING_TIME)(source.areas * np.linalg.norm(one - other, axis=1)) > APART
    ends = edges(source.mesh).ends
    left, right = ends[apart[ends].all(axis=1)].T
    labels = components(left, right, len(apart))
    masks = [apart & (labels == label) for label in np.unique(labels[apart])]
    masks = masks if len(masks) < 2 else [*masks, *exchanged(masks, one, other)]
    return [mask for mask in masks if SHARES[0] < source.areas[mask].sum() < SHARES[1]]


def exchanged(masks: Sequence[Bools], one: Floats, other: Floats) -> list[Bools]:
    """Regions (n,) joined that come to where each other was: two legs that two maps have the other way round."""
    came_from = cKDTree(one).query(other)[1]
    numbered = list(enumerate(masks))
    goes = [(i, j) for i, mask in numbered for j, there in numbered if there[came_from[mask]].mean() > HALF]
    left, right = np.reshape(goes, (-1, 2)).astype(np.int64).T
    labels = components(left, right, len(masks))
    joined = [np.flatnonzero(labels == label).tolist() for label in np.unique(labels)]
    return [np.asarray(np.any([masks[i] for i in several], axis=0)) for several in joined if len(several) > 1]


def _hybrids(source: DeformableMesh, best: Floats, others: Sequence[Floats]) -> Iterator[Floats]:
    """Where vertices go (n, 3) by the best map and, in one region, by another."""
    for other in others:
        for region in regions(source, best, other):
            yield np.where(region[:, None], other, best)


def _untried(source: DeformableMesh, places: Iterable[Floats], tried: list[Floats]) -> list[Floats]:
    """Where vertices go (n, 3), but for what nearly repeats what was `tried`, which grows."""
    found = []
    for y in places:
        if all(source.areas @ ((y - before) ** 2).sum(axis=1) > SAME**2 for before in tried):
            tried.append(y)
            found.append(y)
    return found


def _unlikeliness(one: Proposal) -> float:
    return one.neg_log_likelihood
