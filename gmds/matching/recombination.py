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
from gmds.registration.hybrids import MOST_SETTLED, better_hybrids
from gmds.registration.register import Registered, register, settled
from gmds.registration.settings import COARSE, SIMPLIFIED, TO_IMAGES

MOST_RETURNED = 3  # maps of a round that are registered the way back; set by hand


def recombined(pair: SurfacePair, maps: Sequence[Proposal], more: Sequence[Registered] = ()) -> list[Proposal]:
    """What the likeliest of some maps became, step by step, with regions of the others; none if nothing is likelier.

    Regions come from `more` as well: sources that need not have been registered the way back.
    """
    source, target = pair.simplified
    begin, settle = SIMPLIFIED.with_stages(TO_IMAGES), SIMPLIFIED.with_stages(COARSE)
    best, *rest = sorted(maps, key=_unlikeliness)

    def likeliest(places: list[Floats]) -> Proposal | None:
        begun = side_by_side(lambda place: register(source, target, place, begin), places)
        there = side_by_side(lambda one: settled(source, target, one.y, settle), cheapest(begun)[:MOST_SETTLED])
        back = side_by_side(lambda one: Proposal.completed(pair, one, SIMPLIFIED), cheapest(there)[:MOST_RETURNED])
        return replace(min(back, key=_unlikeliness), improved=True) if back else None

    others = [*(one.registered for one in rest), *more]
    return better_hybrids(source, best, others, lambda now: realigned(source, target, now.registered.y), likeliest)


def _unlikeliness(one: Proposal) -> float:
    return one.neg_log_likelihood
