"""Which extremity of a part is which of a whole: sets of assignments that agree on one scale."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

from geodesics.arrays import Bools, Floats, Integers

TOLERANCE = 0.12  # of the logarithm of a scale: what poses and triangulations change distances by, and half of it again
LEAST_SCALE = 0.85  # of a part of unit area to a whole of unit area, which it cannot be much larger than
MOST_SCALE = 3.2  # the part is a tenth of the area of the whole


class Assignment(NamedTuple):
    """Extremities `ours` (k,) of the part go to `theirs` (k,) of the whole, whose distances are `scale` times smaller.

    `spread`: mean deviation of the logarithm of that scale over all pairs of them.
    """

    ours: tuple[int, ...]
    theirs: tuple[int, ...]
    scale: float
    spread: float


def consistent_assignments(ours: Floats, theirs: Floats, alike: Bools | None = None) -> list[Assignment]:
    """Injective assignments of two or more of k points to q, by mutual distances (k, k), (q, q), known up to a scale.

    Every two pairs of points give a scale; assignments grow from them by points that agree with it (`TOLERANCE`) in the
    distances to all points assigned before. `alike` (k, q) says which may be assigned to which. A cut can only make
    distances of the part longer, never shorter.
    """
    alike = np.ones((len(ours), len(theirs)), dtype=bool) if alike is None else alike
    found: dict[frozenset[tuple[int, int]], Assignment] = {}
    with np.errstate(divide="ignore", invalid="ignore"):
        logs = np.log(ours[:, :, None, None] / theirs[None, None])  # [i, j, a, b]
    for i, j in itertools.combinations(range(len(ours)), 2):
        for a, b in itertools.permutations(range(len(theirs)), 2):
            log = logs[i, j, a, b]
            if alike[i, a] and alike[j, b] and np.log(LEAST_SCALE) < log < np.log(MOST_SCALE):
                grown = _grown([(i, a), (j, b)], logs, float(log), alike)
                for pairs in {
                    2: grown[:2],
                    len(grown): grown,
                }.values():  # what grew by a wrong point was right before
                    key = frozenset(pairs)
                    if key not in found:
                        found[key] = _assignment(sorted(pairs), logs)
    return list(found.values())


def _grown(pairs: list[tuple[int, int]], logs: Floats, log: float, alike: Bools) -> list[tuple[int, int]]:
    """The pairs, and others that agree with all of them on the scale, those that agree best first."""
    gaps = np.where(alike, 0.0, np.inf)  # by how much each pair (i, a) disagrees with any of `pairs`
    for pair in pairs:
        gaps = _disagreement(gaps, logs, log, pair)
    while True:
        i, a = divmod(int(gaps.argmin()), gaps.shape[1])
        if not gaps[i, a] < TOLERANCE:
            return pairs
        pairs = [*pairs, (i, a)]
        gaps = _disagreement(gaps, logs, log, (i, a))


def _disagreement(gaps: Floats, logs: Floats, log: float, pair: tuple[int, int]) -> Floats:
    """The gaps (k, q) with one more pair; inf where its points are taken, and where nothing can be told."""
    j, b = pair
    more = np.maximum(gaps, np.abs(logs[:, j, :, b] - log))
    more[j], more[:, b] = np.inf, np.inf
    more[np.isnan(more)] = np.inf
    return more


def _assignment(pairs: list[tuple[int, int]], logs: Floats) -> Assignment:
    values = np.array([logs[i, j, a, b] for (i, a), (j, b) in itertools.combinations(pairs, 2)])
    middle = float(np.median(values))
    ours, theirs = zip(*pairs, strict=True)
    return Assignment(ours, theirs, float(np.exp(middle)), float(np.abs(values - middle).mean()))


def indices(assignment: Assignment) -> tuple[Integers, Integers]:
    """Both sides of an assignment as index arrays (k,)."""
    return np.array(assignment.ours, dtype=np.int64), np.array(assignment.theirs, dtype=np.int64)
