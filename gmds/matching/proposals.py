"""Many rough maps of two surfaces, weighed by what it costs to deform the one into the other as they say."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.euclidean import euclidean_distances
from geodesics.threads import side_by_side
from gmds.initialization.shortlist import shortlist
from gmds.matching.effort import MOST_GAP, keeps_sizes, largest_gap
from gmds.matching.pair import SurfacePair
from gmds.registration.deformable import DeformableMesh
from gmds.registration.distinct import distinct
from gmds.registration.register import Registered, register, returning, settled
from gmds.registration.residuals import Residuals
from gmds.registration.settings import COARSE, SIMPLIFIED, TO_IMAGES, RegistrationSettings
from gmds.spectral.sample_maps import SampledPair
from gmds.surface.view import View

Start = Callable[[SampledPair], list[Integers]]
Views = Callable[[], Sequence[tuple[View, View]]]

MAPS_PER_METRIC = 16  # proposed: what is weighed in benchmarks/results/notes.md, "Choice by elastic energy"
LEAST_SETTLED = 8  # maps, at the least, that are registered to the end; set by hand
# Maps, the most likely, that are registered the way back as well: the three best of 32 were among the first 12 on six
# development pairs (benchmarks/results/notes.md, "Speed of a match").
MOST_RETURNED = 12
# Root mean square gaps, in root areas, below which two maps that have only begun lead to the same, and below which two
# maps are one. The first saves 0.3 CPU seconds (the same file, "Faster by a third"). Both set by hand.
SAME_BEGINNING = 0.03
SAME_MAP = 0.05
EMBEDDED = 3  # maps of a pair, at the most, whose samples are placed: each costs 0.8 CPU seconds; set by hand
# Of log-likelihood from the best: no map that fell short by more was the answer on 15 development pairs, the farthest
# by 0.05 (benchmarks/results/notes.md, "Speed of a match").
SHORTFALL = 0.8
# Negative log-likelihood below which the likeliest map in the metric of space is taken, and no other metric asked, if
# it reaches everything: of 216 pairs it was right for all closed ones, with a mean error of 0.051 root areas at the
# most, and where parts grew or another map is nearly as likely the other metrics find none that is better
# (benchmarks/results/notes.md, "Effort").
DECISIVE = -10.5
FEWEST_DECIDED = 2000  # vertices: with fewer the other metrics do find better maps ("Effort" there)

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Proposal:
    """A map of the simplified source, `registered` to the simplified target, and the target `back` to it.

    `improved`: whether it began with all eigenfunctions, positions and normals already, or with parts of other maps.
    """

    registered: Registered
    back: Registered
    improved: bool = False

    @classmethod
    def of(cls, pair: SurfacePair, places: Floats) -> Proposal:
        """The map that sends the vertices of the simplified source to `places` (n, 3)."""
        return cls.completed(pair, register(*pair.simplified, places, SIMPLIFIED), SIMPLIFIED)

    @classmethod
    def completed(cls, pair: SurfacePair, there: Registered, settings: RegistrationSettings) -> Proposal:
        """The map of the simplified source `there` on the simplified target, and that registered the way back."""
        source, target = pair.simplified
        return cls(there, register(target, source, returning(source, target, there.y), settings.reversed))

    @property
    def residuals(self) -> tuple[Residuals, Residuals]:
        """What is left of both deformations."""
        return self.registered.residuals, self.back.residuals

    @property
    def neg_log_likelihood(self) -> float:
        """Minus the log-likelihood of the map up to a constant.

        Both ways: half a body can be bent onto a whole one in many ways, the whole on the half in few.
        """
        return sum(residuals.neg_log_likelihood for residuals in self.residuals)


class Proposed(NamedTuple):
    """The maps, and whether the likeliest, decided before the last round, is `isometric`: keeps the sizes of parts.

    `settled`: the sources of all that were registered to the end, of the maps and of those not registered the way back.
    """

    maps: list[Proposal]
    isometric: bool
    settled: list[Registered]


def proposals(
    pair: SurfacePair,
    rounds: Sequence[Views],
    starts: Sequence[Start],
    progress: Callable[[float], None] | None = None,
) -> Proposed:
    """Maps from starts in pairs of views, and composed with a reflection, each registered on the simplified meshes.

    A reflection of either surface makes of a mirrored map the right one, and of a right one the mirrored. Which is
    which shows when the simplified source is deformed: a surface cannot be turned inside out for little. The third
    that needs the least deformation to begin with is registered to the end, and `MOST_RETURNED` of these the way back.

    The views of a round are not asked for where nothing can be missing and a map of those before is `DECISIVE`.
    """
    source, target = pair.simplified
    begin, settle = SIMPLIFIED.with_stages(TO_IMAGES), SIMPLIFIED.with_stages(COARSE)
    there = _Kept(lambda start: settled(source, target, start.y, settle))
    done = _Kept(functools.partial(Proposal.completed, pair, settings=SIMPLIFIED))
    begun: list[Registered] = []
    for number, views in enumerate(rounds):
        parts = [_part(progress, number, len(rounds), *shares) for shares in ((0.6, 0.75), (0.75, 0.9), (0.9, 1.0))]
        places = [target.mesh.vertices[images] for images in rough_maps(pair, views(), starts)]
        begun += side_by_side(lambda place: register(source, target, place, begin), places, parts[0])
        cheap = _without_repeats(cheapest(begun)[: max(LEAST_SETTLED, len(begun) // 3)], source)
        ended = cheapest(there.of(cheap, parts[1]))
        maps = done.of(ended[:MOST_RETURNED], parts[2])
        best = min(maps, key=lambda one: one.neg_log_likelihood)
        if number + 1 < len(rounds) and _decisive(pair, best):
            return Proposed(maps, keeps_sizes(source, best.registered.y), ended)
    return Proposed(maps, isometric=False, settled=ended)


def _decisive(pair: SurfacePair, best: Proposal) -> bool:
    """Whether a map is so likely that it is right: nothing can be missing, and no region of either is off the other."""
    fewest = min(len(surface.regular.usable) for surface in (pair.source, pair.target))
    if not pair.closed or fewest < FEWEST_DECIDED or best.neg_log_likelihood > DECISIVE:
        return False
    ways = zip(pair.simplified, (best.registered, best.back), strict=True)
    return max(largest_gap(*way) for way in ways) < MOST_GAP


class _Kept(Generic[T]):
    """A function of deformations, each computed once however often it is asked for."""

    def __init__(self, function: Callable[[Registered], T]) -> None:
        self._function = function
        self._found: dict[Registered, T] = {}

    def of(self, asked: Sequence[Registered], progress: Callable[[float], None]) -> list[T]:
        """What it makes of each, in their order."""
        new = [one for one in asked if one not in self._found]
        self._found |= zip(new, side_by_side(self._function, new, progress), strict=True)
        return [self._found[one] for one in asked]


def _part(
    progress: Callable[[float], None] | None, number: int, count: int, start: float, end: float
) -> Callable[[float], None]:
    """Reports to `progress` a part of round `number` of `count`, which begins and ends at these shares of it."""
    return lambda share: None if progress is None else progress((number + start + (end - start) * share) / count)


def cheapest(deformations: Sequence[Registered]) -> list[Registered]:
    """Those that need the least deformation first."""
    return sorted(deformations, key=lambda one: one.residuals.neg_log_likelihood)


def _without_repeats(deformations: Sequence[Registered], source: DeformableMesh) -> list[Registered]:
    """Those that no one before them nearly repeats."""
    rows = np.stack([(np.sqrt(source.areas)[:, None] * one.y).ravel() for one in deformations])
    gaps = euclidean_distances(rows, rows)
    kept: list[int] = []
    for i in range(len(deformations)):
        if (gaps[i, kept] > SAME_BEGINNING).all():
            kept.append(i)
    return [deformations[i] for i in kept]


def rough_maps(pair: SurfacePair, views: Sequence[tuple[View, View]], starts: Sequence[Start]) -> list[Integers]:
    """Maps (p,) from the vertices of the simplified source to those of the target's, before and after a reflection."""
    (here, there), (ours, theirs) = pair.simplified, pair.reflections
    row = np.zeros(pair.target.mesh.n_vertices, dtype=np.int64)
    row[there.origin] = np.arange(len(there.origin))
    sampled = side_by_side(lambda both: SampledPair.of(*both), views)
    short = [(one, images) for one in sampled for images in shortlist(one, starts, MAPS_PER_METRIC)]

    def extended(origin: Integers) -> list[Integers]:
        return side_by_side(lambda each: row[each[0].extended(each[1], origin, there.origin)], short)

    straight = extended(here.origin)
    turned = [] if ours is None else extended(ours[here.origin])
    if theirs is not None:
        back = there.places.query(pair.target.mesh.vertices[theirs[there.origin]])[1]
        turned = [back[images] for images in straight]
    return straight + turned


def likely_maps(maps: Sequence[Proposal], areas: Floats) -> list[Proposal]:
    """The few proposals that deserve more work, the likeliest first, apart from each other."""
    return distinct(maps, areas, SAME_MAP, count=EMBEDDED, within=SHORTFALL)
