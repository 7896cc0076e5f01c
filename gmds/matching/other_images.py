"""Whether the mirror image of a target, or the target with its faces turned, fits far better than it does as it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.special import expit

from gmds.correspondence import Correspondence
from gmds.maps.point_map import Candidate, MatchStatus
from gmds.matching.attempts import Attempt, Orientation, Wanted
from gmds.matching.pair import SurfacePair
from gmds.matching.part_answers import likelier_part
from gmds.matching.proposals import likeliest, proposals
from gmds.matching.rating import AMBIGUOUS_MARGIN
from gmds.matching.result import correspondence_of
from gmds.matching.steps import rounds_of, starts_of
from gmds.parts.handedness import AS_IT_IS, INSIDE_OUT, MIRRORED, Image, image_costs
from gmds.registration.residuals import Residuals

# A surface whose own mirror image has this correlation of curvature with it at the least is as good as symmetric: it
# has no handedness. Else another image of the target is weighed where it fits without bending at such a cost at most,
# and at a log cost above that of the target as it is by so much at most. What has limbs lies in another pose as its own
# mirror image does: there the image has to cost less, by so much in the logarithm. Chosen on the development half of
# benchmarks/results/mirrored.md, but for limbs: of all whole bodies there it was 0.13 less at the most.
SYMMETRIC = 0.6
MOST_COST = 0.4
MOST_EXCESS = 0.25
LESS_WITH_LIMBS = 0.3  # and where all normals would be the other way round
# By how much it then has to be likelier, of maps that are finished where they are of wholes: as much as makes a map
# AMBIGUOUS. Of mirrored teeth it was 0.97 and more but for two (0.02 and 0.55), of others below -0.5.
FAR_LIKELIER = AMBIGUOUS_MARGIN
# Where bending may hide it, how much more of the curvature the mirror image has to explain in a first look, and by
# finished maps, as a difference of log-likelihood; and the symmetry above which nothing is looked at where the metric
# of space decides (benchmarks/results/notes.md, "Confidence": hands of two creatures of TOSCA, and bodies).
WORTH_A_LOOK = 0.2
MORE_EXPLAINED = 0.7
AS_BODIES_ARE = 0.9
TINY = 1e-12  # a bound, so that a logarithm is finite


def likelier_image(found: Sequence[Attempt], orientation: Orientation, wanted: Wanted) -> Attempt | None:
    """What is proposed for another image of the target, where that is far likelier than all that was `found`."""
    if orientation == "reverse":
        return None
    image = suspected_image(found)
    if by_curvature := image is None and explains_more(found):
        image = MIRRORED
    if image is None:
        return None
    other = Attempt.at(found[0].pair.source, found[0].pair.target, image, wanted)
    if _whole(other) > min(map(_whole, found)):
        return None  # before parts are looked for
    if by_curvature and curvature_gain(found, other) < MORE_EXPLAINED:
        return None
    return other if gain_of(found, other) > FAR_LIKELIER else None


def gain_of(found: Sequence[Attempt], other: Attempt) -> float:
    """How much likelier the `other` is than all that was `found`: a difference of log-likelihood.

    Finished maps tell more than those that are proposed, and are compared where they are of wholes.
    """
    ways, wanted = [*found, other], other.wanted
    if wanted.distance is None and not any(likelier_part(way.of_parts, way.maps, wanted.parts) for way in ways):
        ours = min(one.finished[0].neg_log_likelihood for one in found)
        return ours - other.finished[0].neg_log_likelihood
    return min(one.neg_log_likelihood for one in found) - other.neg_log_likelihood


def suspected_image(found: Sequence[Attempt]) -> Image | None:
    """The image of the target, not among those that were tried, that is worth to be weighed, if there is one.

    Faces that are turned show where there is a boundary: a closed surface has an outside.
    """
    pair, tried = found[0].pair, [one.image for one in found]
    is_open = any(mesh.boundary.any() for mesh in pair.simplified)
    images = [one for one in (AS_IT_IS, MIRRORED, *INSIDE_OUT) if is_open or not one.turned]
    if own_symmetry(pair) > SYMMETRIC:
        images = [one for one in images if not one.reflected or one in tried]
    if set(images) <= set(tried):
        return None
    costs = image_costs(pair.source, pair.target, pair.simplified, images)
    cost = dict(zip(images, np.maximum(costs, TINY), strict=True))
    best = min((one for one in images if one not in tried), key=lambda one: cost[one])
    excess = MOST_EXCESS if pair.limbless and not best.turned else -LESS_WITH_LIMBS
    likely = np.log(cost[best]) < min(np.log(cost[one]) for one in tried) + excess
    return best if likely and cost[best] < MOST_COST else None


def explains_more(found: Sequence[Attempt]) -> bool:
    """Whether the first maps to the mirror image of a closed target explain more of its curvature.

    A left hand takes every pose of a right one but for what tells palm from back: their curvature. Two poses of a body,
    bent to one side and to the other, have the same curvature, however likelier their mirror images are.
    """
    pair, tried = found[0].pair, [one.image for one in found]
    if not pair.closed or MIRRORED in tried or (pair.isometric and own_symmetry(pair) > AS_BODIES_ARE):
        return False
    image = SurfacePair(pair.source, MIRRORED.of(pair.target), found[0].wanted.landmarks, MIRRORED.reverses)
    rounds, _ = rounds_of(image, found[0].wanted.distance)
    there = likeliest(proposals(image, rounds[:1], starts_of(image)).maps)
    here = likeliest([one for attempt in found for one in attempt.maps])
    gain = unexplained_curvature(here.residuals) - unexplained_curvature(there.residuals)
    return here.neg_log_likelihood > there.neg_log_likelihood and gain > WORTH_A_LOOK


def curvature_gain(found: Sequence[Attempt], other: Attempt) -> float:
    """How much more of the curvature the likeliest finished map of another image explains than the likeliest `found`."""
    ours = min((one.finished[0] for one in found), key=lambda one: one.neg_log_likelihood)
    here, there = ((one.simplified, one.simplified_back, one.whole) for one in (ours.evidence, other.finished[0].evidence))
    return unexplained_curvature(here) - unexplained_curvature(there)


def unexplained_curvature(residuals: Sequence[Residuals]) -> float:
    """The part of a negative log-likelihood that curvature accounts for."""
    return sum(one.unexplained_curvature for one in residuals)


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


def with_candidate(answer: Correspondence, found: Sequence[Attempt], other: Attempt) -> Correspondence:
    """The answer, POOR since another image of the target is far likelier than all `found`, whose map is a candidate.

    Its confidence is that of the map if it is the right one of both, which is less likely than not.
    """
    gain = gain_of(found, other)
    part = likelier_part(other.of_parts, other.maps, other.wanted.parts)
    image = correspondence_of(other.finished[:1], {}) if part is None else part.correspondence({})
    evidence = image.meta["evidence"]
    candidate = Candidate(image.points, evidence["stress"], evidence["orientation"])
    confidence = answer.confidence * expit(-gain)
    return replace(answer, status=MatchStatus.POOR, confidence=confidence, candidates=(candidate, *answer.candidates))
