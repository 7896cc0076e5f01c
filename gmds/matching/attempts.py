"""What is proposed for a target as it is, and for its mirror image, and what becomes of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from geodesics import Distance, Mesh
from geodesics.caching import cached_property
from gmds.landmarks.constraints import LandmarkConstraints
from gmds.matching.annealing import annealed
from gmds.matching.candidates import MapCandidate
from gmds.matching.contradictions import believed
from gmds.matching.given_distances import GivenDistances
from gmds.matching.pair import SurfacePair
from gmds.matching.part_answers import PartAnswer, Parts, maps_of_parts
from gmds.matching.proposals import Proposal, Proposed, likely_maps, proposals
from gmds.matching.recombination import recombined
from gmds.matching.steps import Report, embedded, registered, rounds_of, starts_of
from gmds.mds.losses import Loss
from gmds.parts.handedness import AS_IT_IS, MIRRORED, Image
from gmds.surface.measured import Surface

Orientation = Literal["preserve", "reverse", "any", "auto"]
ASKED: dict[Orientation, tuple[Image, ...]] = {
    "preserve": (AS_IT_IS,),
    "reverse": (MIRRORED,),
    "any": (AS_IT_IS, MIRRORED),
    "auto": (AS_IT_IS,),
}


@dataclass(frozen=True)
class Wanted:
    """What a match is asked for, beside the surfaces; `looked_for`: whether parts may be."""

    landmarks: LandmarkConstraints | None
    distance: Callable[[Mesh], Distance] | None
    loss: Loss
    count: int
    parts: Parts
    report: Report
    looked_for: bool


@dataclass(frozen=True, eq=False)
class Attempt:
    """The likely maps to an `image` of the target, none of them embedded."""

    image: Image
    pair: SurfacePair
    maps: list[Proposal]
    given: GivenDistances | None
    wanted: Wanted

    @classmethod
    def at(cls, source: Surface, target: Surface, image: Image, wanted: Wanted) -> Attempt:
        """What is proposed for an image of the target."""
        pair = SurfacePair(source, image.of(target), wanted.landmarks, image.reverses)
        rounds, given = rounds_of(pair, wanted.distance)

        def propose(pair: SurfacePair, count: int | None) -> Proposed:
            return proposals(pair, rounds[:count], starts_of(pair))

        def better(pair: SurfacePair, found: Proposed) -> list[Proposal]:
            return found.maps if given is not None or found.isometric else improved(pair, found)

        found = proposals(pair, rounds, starts_of(pair), lambda share: wanted.report("proposing", 0.2 + 0.3 * share))
        pair = replace(pair, isometric=found.isometric)
        pair, maps = believed(pair, found, better(pair, found), propose, better)
        return cls(image, pair, likely_maps(maps, pair.simplified[0].areas), given, wanted)

    @cached_property
    def of_parts(self) -> list[PartAnswer]:
        """What comes of taking one for a part of the other, where that may be."""
        wanted = self.wanted
        if not wanted.looked_for:
            return []
        return maps_of_parts(self.pair, self.maps, wanted.parts, wanted.loss, wanted.count, wanted.report)

    @property
    def neg_log_likelihood(self) -> float:
        """That of the likeliest map, whole or in part."""
        whole = [one.neg_log_likelihood for one in self.maps]
        return min(whole + [one.neg_log_likelihood for one in self.of_parts]) + self.pair.given_up

    @cached_property
    def finished(self) -> list[MapCandidate]:
        """The maps of the whole, embedded and registered, the likeliest first."""
        return finished([self])


def improved(pair: SurfacePair, found: Proposed) -> list[Proposal]:
    """The maps that were found, and what annealing makes of them, and what can be put together of all.

    With landmarks nothing is put together: they count in the likelihood, and a wrong one would have a region its way.
    """
    maps = [*found.maps, *annealed(pair, found.maps)]
    return maps if pair.landmarks is not None else [*maps, *recombined(pair, maps, found.settled)]


def attempted(source: Surface, target: Surface, orientation: Orientation, wanted: Wanted) -> list[Attempt]:
    """What is proposed for each image of the target that is asked for."""
    return [Attempt.at(source, target, image, wanted) for image in ASKED[orientation]]


def finished(attempts: Sequence[Attempt]) -> list[MapCandidate]:
    """The maps of the whole that are proposed in all of them, embedded and registered, the likeliest first."""
    wanted = attempts[0].wanted
    how = wanted.loss, wanted.count
    candidates = [one for way in attempts for one in embedded(way.pair, way.maps, *how, way.given, wanted.report)]
    candidates.sort(key=lambda candidate: candidate.neg_log_likelihood)
    return registered(candidates, wanted.report) if wanted.distance is None else candidates
