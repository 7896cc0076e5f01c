"""Maps put together of two: one, and in one region what another has there.

Where two maps of a surface lead apart, connected region by connected region, the source is sent where the other has it
(the crossover of genetic algorithms, which ENIGMA does with maps of landmarks: Edelstein, Ezuz, Ben-Chen 2020; here
nothing is random).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np
from scipy.spatial import cKDTree

from geodesics.arrays import Bools, Floats
from geodesics.topology.edges import components, edges
from gmds.registration.deformable import DeformableMesh
from gmds.registration.distinct import M
from gmds.registration.register import Registered

# Root areas of the target between where two maps lead, smoothed over the surface in this heat time, from which they
# differ there: 0.07 did no better on development pairs (benchmarks/results/notes.md, "Recombination"). Shares of the
# area that a region has: set by hand.
APART = 0.1
SMOOTHING_TIME = 2e-3
SHARES = (0.01, 0.5)
HALF = 0.5  # of a region comes to where another was, if they are exchanged: a bound
SAME = 0.02  # root areas, root mean square, below which two maps are put together alike: a bound
MOST_ROUNDS = 4  # set by hand
# Of log-likelihood in a round, as of annealing: less makes maps better as often as worse (benchmarks/results/notes.md,
# "Recombination").
LEAST_GAIN = 0.1
MOST_SETTLED = 6  # maps of a round, by what they cost after few iterations, that are registered to the end; set by hand


def better_hybrids(
    source: DeformableMesh,
    best: M,
    others: Iterable[Registered],
    laid_anew: Callable[[M], Iterable[Floats]],
    likeliest: Callable[[list[Floats]], M | None],
) -> list[M]:
    """What a map became, step by step, with regions of others and those `laid_anew`; none if nothing is likelier.

    `likeliest` registers the source from each of some places (n, 3), and returns the likeliest map of them, if any.
    """
    found: list[M] = []
    tried: list[Floats] = []
    others = list(others)
    for _ in range(MOST_ROUNDS):
        changed = [*hybrids(source, best.registered.y, [one.y for one in others]), *laid_anew(best)]
        now = likeliest(untried(source, changed, tried))
        if now is None or now.neg_log_likelihood > best.neg_log_likelihood - LEAST_GAIN:
            break
        others.append(best.registered)
        best = now
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


def hybrids(source: DeformableMesh, best: Floats, others: Sequence[Floats]) -> Iterator[Floats]:
    """Where vertices go (n, 3) by the best map and, in one region, by another."""
    for other in others:
        for region in regions(source, best, other):
            yield np.where(region[:, None], other, best)


def untried(source: DeformableMesh, places: Iterable[Floats], tried: list[Floats]) -> list[Floats]:
    """Where vertices go (n, 3), but for what nearly repeats what was `tried`, which grows."""
    found = []
    for y in places:
        if all(source.areas @ ((y - before) ** 2).sum(axis=1) > SAME**2 for before in tried):
            tried.append(y)
            found.append(y)
    return found
