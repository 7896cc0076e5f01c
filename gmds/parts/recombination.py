"""Rough maps of a part put together, as maps of a whole are in `gmds.matching.recombination`.

Of a person seen from one side, legs are the same from behind, and one map has a leg right that another has not.
"""

from __future__ import annotations

from collections.abc import Sequence

from geodesics.arrays import Floats
from geodesics.threads import side_by_side
from gmds.parts.part_map import ONTO_WHOLE, PartMap
from gmds.parts.realignment import realigned
from gmds.registration.deformable import DeformableMesh
from gmds.registration.hybrids import MOST_SETTLED, better_hybrids
from gmds.registration.register import register, settled
from gmds.registration.settings import COARSE, TO_IMAGES

SHARES = (0.04, 0.08, 0.15, 0.3)  # of the area of a part, of which a limb may be a third; set by hand

BEGIN, SETTLE = ONTO_WHOLE.with_stages(TO_IMAGES), ONTO_WHOLE.with_stages(COARSE)


def recombined(source: DeformableMesh, target: DeformableMesh, maps: Sequence[PartMap]) -> list[PartMap]:
    """What the likeliest of some maps of a part became, step by step; none if nothing is likelier."""
    best, *rest = sorted(maps, key=_unlikeliness)

    def likeliest(places: list[Floats]) -> PartMap | None:
        begun = side_by_side(lambda place: PartMap.of(source, register(source, target, place, BEGIN)), places)
        likely = sorted(begun, key=_unlikeliness)[:MOST_SETTLED]
        done = side_by_side(lambda one: PartMap.of(source, settled(source, target, one.registered.y, SETTLE)), likely)
        return min(done, key=_unlikeliness, default=None)

    def laid_anew(now: PartMap) -> list[Floats]:
        return realigned(source, target, now.registered.y, now.size, SHARES)

    return better_hybrids(source, best, [one.registered for one in rest], laid_anew, likeliest)


def _unlikeliness(one: PartMap) -> float:
    return one.neg_log_likelihood
