"""What is proposed for a target as it is, and for its mirror image, and whether that fits far better."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.special import expit

from geodesics import Distance, Mesh
from geodesics.caching import cached_property
from gmds.correspondence import Correspondence
from gmds.landmarks.constraints import LandmarkConstraints
from gmds.maps.point_map import Candidate, MatchStatus
from gmds.matching.annealing import annealed
from gmds.matching.candidates import make_candidate
from gmds.matching.contradictions import believed
from gmds.matching.given_distances import GivenDistances
from gmds.matching.pair import SurfacePair
from gmds.matching.part_answers import PartAnswer, Parts, likelier_part, maps_of_parts
from gmds.matching.proposals import Proposal, Proposed, likely_maps, proposals
from gmds.matching.rating import AMBIGUOUS_MARGIN
from gmds.matching.recombination import recombined
from gmds.matching.result import correspondence_of
from gmds.matching.steps import Report, rounds_of, starts_of
from gmds.mds.losses import Loss
from gmds.parts.handedness import AS_IT_IS, INSIDE_OUT, MIRRORED, Image, image_costs
from gmds.surface.measured import Surface

Orientation = Literal["preserve", "reverse", "any", "auto"]
ASKED: dict[Orientation, tuple[Image, ...]] = {
    "preserve": (AS_IT_IS,),
    "reverse": (MIRRORED,),
    "any": (AS_IT_IS, MIRRORED),
    "auto": (AS_IT_IS,),
}

# A surface whose own mirror image has this correlation of curvature with it at the least is as good as symmetric: it
# has no handedness. Else another image of the target is weighed where it fits without bending at such a cost at most,
# and at a log cost above that of the target as it is by so much at most. Where the likeliest map explains curvature as
# well as to a log-likelihood below the last it has to be below it by `LEAST_GAIN`: a round shape is explained by its
# mirror image too. Then it has to be likelier by as much as makes a map AMBIGUOUS. Chosen on the development half of
# benchmarks/results/mirrored.md.
SYMMETRIC = 0.6
MOST_COST = 0.36
MOST_EXCESS = 0.03
LEAST_UNEXPLAINED = -1.2
LEAST_GAIN = 0.3  # of log cost, where all normals would be the other way round, or all is explained; set by hand
FAR_LIKELIER = AMBIGUOUS_MARGIN
TINY = 1e-12  # a bound, so that a logarithm is finite


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
    """The likely maps to an `image` of the target, none of them embedded; those `proposed` are as first made."""

    image: Image
    pair: SurfacePair
    maps: list[Proposal]
    proposed: list[Proposal]
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
        pair, *some = believed(pair, found, better(pair, found), propose, better)
        likely, proposed = (likely_maps(maps, pair.simplified[0].areas) for maps in some)
        return cls(image, pair, likely, proposed, given, wanted)

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

    @property
    def unexplained(self) -> float:
        """Of the map that explains most of it, the log of the parts of curvature that are unexplained, both ways.

        Of maps as they are proposed: regions laid anew fit each by itself, and to the mirror image nearly as well.
        """
        of_maps = [one.residuals for one in self.proposed]
        of_parts = [one.candidates[0].candidate.evidence.both_simplified for one in self.of_parts]
        both = [(one.curvature, one.curvature_back) for ways in (*of_maps, *of_parts) for one in ways]
        values = np.reshape(both, (-1, 4))
        return float(np.log(np.maximum(1 - np.clip(values, 0.0, 1.0) ** 2, TINY)).sum(axis=1).min() / 2)


def improved(pair: SurfacePair, found: Proposed) -> list[Proposal]:
    """The maps that were found, and what annealing makes of them, and what can be put together of all.

    With landmarks nothing is put together: they count in the likelihood, and a wrong one would have a region its way.
    """
    maps = [*found.maps, *annealed(pair, found.maps)]
    return maps if pair.landmarks is not None else [*maps, *recombined(pair, maps, found.settled)]


def attempted(source: Surface, target: Surface, orientation: Orientation, wanted: Wanted) -> list[Attempt]:
    """What is proposed for each image of the target that is asked for."""
    return [Attempt.at(source, target, image, wanted) for image in ASKED[orientation]]


def likelier_image(found: Sequence[Attempt], orientation: Orientation, wanted: Wanted) -> Attempt | None:
    """What is proposed for another image of the target, where that is far likelier than all that was `found`."""
    image = None if orientation == "reverse" else suspected_image(found)
    if image is None:
        return None
    other = Attempt.at(found[0].pair.source, found[0].pair.target, image, wanted)
    if _whole(other) > min(map(_whole, found)):
        return None  # before parts are looked for
    return other if other.neg_log_likelihood < min(one.neg_log_likelihood for one in found) - FAR_LIKELIER else None


def suspected_image(found: Sequence[Attempt]) -> Image | None:
    """The image of the target, not among those that were tried, that is worth to be weighed, if there is one.

    Faces that are turned show where there is a boundary: a closed surface has an outside.
    """
    pair, tried = found[0].pair, [one.image for one in found]
    is_open = any(mesh.boundary.any() for mesh in pair.simplified)
    images = [one for one in (AS_IT_IS, MIRRORED, *INSIDE_OUT) if is_open or not one.turned]
    if own_symmetry(pair) > SYMMETRIC:
        images = [one for one in images if not one.reflected or one in tried]
    explained = min(one.unexplained for one in found) < LEAST_UNEXPLAINED
    if set(images) <= set(tried):
        return None
    costs = image_costs(pair.source, pair.target, pair.simplified, images)
    cost = dict(zip(images, np.maximum(costs, TINY), strict=True))
    best = min((one for one in images if one not in tried), key=lambda one: cost[one])
    excess = -LEAST_GAIN if best.turned or explained else MOST_EXCESS
    likely = np.log(cost[best]) < min(np.log(cost[one]) for one in tried) + excess
    return best if likely and cost[best] < MOST_COST else None


def own_symmetry(pair: SurfacePair) -> float:
    """Correlation of squashed curvature with its own reflection, of the source or else of the target; 0 for none."""
    for surface, images in zip((pair.source, pair.target), pair.reflections, strict=True):
        if images is not None:
            share, values = surface.areas / surface.areas.sum(), surface.squashed_curvature
            here, there = (rows - share @ rows for rows in (values, values[images]))
            return float(share @ (here * there) / max(np.sqrt((share @ here**2) * (share @ there**2)), TINY))
    return 0.0


def _whole(attempt: Attempt) -> float:
    return min(one.neg_log_likelihood for one in attempt.maps) + attempt.pair.given_up


def with_candidate(answer: Correspondence, found: Sequence[Attempt], other: Attempt, wanted: Wanted) -> Correspondence:
    """The answer, POOR since another image of the target is far likelier than all `found`, whose map is a candidate.

    Its confidence is that of the map if it is the right one of both, which is less likely than not.
    """
    gain = min(one.neg_log_likelihood for one in found) - other.neg_log_likelihood
    part = likelier_part(other.of_parts, other.maps, wanted.parts)
    if part is None:
        best = make_candidate(other.pair, other.maps[0], wanted.loss, wanted.count, other.given)
        image = correspondence_of([best], {})
    else:
        image = part.correspondence({})
    evidence = image.meta["evidence"]
    candidate = Candidate(image.points, evidence["stress"], evidence["orientation"])
    confidence = answer.confidence * expit(-gain)
    return replace(answer, status=MatchStatus.POOR, confidence=confidence, candidates=(candidate, *answer.candidates))
