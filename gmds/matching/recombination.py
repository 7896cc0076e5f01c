"""Proposals put together: the likeliest, and in one region after another what a less likely one has there.

Of many maps one has the neck right and another the legs, and none both. The simplified source is sent where a map put
together of two has it (`gmds.registration.hybrids`), and registered anew; what is likelier replaces the likeliest,
until nothing is. What none has, a head the right way round, may come of a region that is laid on the target anew
(`gmds.parts.realignment`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from geodesics.arrays import Floats
from geodesics.threads import side_by_side
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal, cheapest
from gmds.parts.realignment import realigned
from gmds.registration.hybrids import hybrids, untried
from gmds.registration.register import Registered, register, settled
from gmds.registration.settings import COARSE, SIMPLIFIED, TO_IMAGES

# Rounds, and how many maps of each are registered to the end, and the way back: set by hand.
MOST_ROUNDS = 4
MOST_SETTLED = 6
MOST_RETURNED = 3
# Of log-likelihood in a round, as of annealing: less makes maps better as often as worse (benchmarks/results/notes.md,
# "Recombination").
LEAST_GAIN = 0.1


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
        changed = [*hybrids(source, y, [one.y for one in others]), *realigned(source, target, y)]
        places = untried(source, changed, tried)
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


def _unlikeliness(one: Proposal) -> float:
    return one.neg_log_likelihood
