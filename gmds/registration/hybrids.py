"""Maps put together of two: one, and in one region what another has there.

Where two maps of a surface lead apart, connected region by connected region, the source is sent where the other has it
(the crossover of genetic algorithms, which ENIGMA does with maps of landmarks: Edelstein, Ezuz, Ben-Chen 2020; here
nothing is random).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from scipy.spatial import cKDTree

from geodesics.arrays import Bools, Floats
from geodesics.topology.edges import components, edges
from gmds.registration.deformable import DeformableMesh

# Root areas of the target between where two maps lead, smoothed over the surface in this heat time, from which they
# differ there: 0.07 did no better on development pairs (benchmarks/results/notes.md, "Recombination"). Shares of the
# area that a region has: set by hand.
APART = 0.1
SMOOTHING_TIME = 2e-3
SHARES = (0.01, 0.5)
HALF = 0.5  # of a region comes to where another was, if they are exchanged: a bound
SAME = 0.02  # root areas, root mean square, below which two maps are put together alike: a bound


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
