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
from gmds.matching.proposals import Proposal, proposals
from gmds.matching.rating import AMBIGUOUS_MARGIN
from gmds.matching.result import correspondence_of
from gmds.matching.steps import rounds_of, starts_of
from gmds.parts.handedness import AS_IT_IS, AXES, INSIDE_OUT, MIRRORED, Image, image_costs
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
    image = None if orientation == "reverse" else suspected_image(found)
    return None if image is None else _far_likelier(found, image, wanted)


def rival_image(found: Sequence[Attempt], orientation: Orientation, wanted: Wanted) -> Attempt | None:
    """What is proposed for the mirror image of the target, where that may be meant although nothing says so.

    A left hand takes every pose of a right one; what tells palm from back is their curvature. A body bent to the other
    side has another curvature as well, where it is bent: either map may be the right one.
    """
    if orientation == "reverse" or not explains_more(found):
        return None
    other = _far_likelier(found, MIRRORED, wanted)
    return None if other is None or curvature_gain(found, other) < MORE_EXPLAINED else other


def _far_likelier(found: Sequence[Attempt], image: Image, wanted: Wanted) -> Attempt | None:
    other = Attempt.at(found[0].pair.source, found[0].pair.target, image, wanted)
    if _whole(other) > min(map(_whole, found)):
        return None  # before parts are looked for
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

    Not asked with a distance that is given: what is registered then only begins a map.
    """
    pair = found[0].pair
    if not pair.closed or found[0].wanted.distance is not None or MIRRORED in [one.image for one in found]:
        return False
    if pair.isometric and own_symmetry(pair) > AS_BODIES_ARE:
        return False
    here = _likeliest([one for attempt in found for one in attempt.maps])
    there = _first_mirrored(found[0], here)
    gain = unexplained_curvature(here.residuals) - unexplained_curvature(there.residuals)
    return here.neg_log_likelihood > there.neg_log_likelihood and gain > WORTH_A_LOOK


def _first_mirrored(attempt: Attempt, best: Proposal) -> Proposal:
    """The likeliest of the first maps to the mirror image.

    Where parts keep their sizes a reflection of the source takes the `best` map there; else starts are refined in the
    metric of space.
    """
    pair, wanted = attempt.pair, attempt.wanted
    image = SurfacePair(pair.source, MIRRORED.of(pair.target), wanted.landmarks, MIRRORED.reverses)
    reflection = pair.reflections[0]
    if pair.isometric and reflection is not None:
        here = image.simplified[0]
        places = pair.source.mesh.vertices[reflection[here.origin]]
        return Proposal.of(image, best.registered.y[here.places.query(places)[1]] * AXES)
    return _likeliest(proposals(image, rounds_of(image, None)[0][:1], starts_of(image)).maps)


def _likeliest(maps: Sequence[Proposal]) -> Proposal:
    """The likeliest of some proposals."""
    return min(maps, key=lambda one: one.neg_log_likelihood)


def curvature_gain(found: Sequence[Attempt], other: Attempt) -> float:
    """How much more of the curvature the finished map to another image explains than the likeliest that was `found`."""
    ours = min((one.finished[0] for one in found), key=lambda one: one.neg_log_likelihood)
    maps = ours.evidence, other.finished[0].evidence
    here, there = (unexplained_curvature((one.simplified, one.simplified_back, one.whole)) for one in maps)
    return here - there


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


def with_candidate(
    answer: Correspondence, found: Sequence[Attempt], other: Attempt, *, undecided: bool = False
) -> Correspondence:
    """The answer with the map to another image of the target as a candidate: far likelier than all `found`, so POOR.

    Its confidence is that of the map if it is the right one of both, which is less likely than not. `undecided`: a body
    in a mirrored pose would look alike; the answer is AMBIGUOUS at the best, and the one map as likely as the other.
    """
    gain = 0.0 if undecided else gain_of(found, other)
    part = likelier_part(other.of_parts, other.maps, other.wanted.parts)
    image = correspondence_of(other.finished[:1], {}) if part is None else part.correspondence({})
    evidence = image.meta["evidence"]
    candidate = Candidate(image.points, evidence["stress"], evidence["orientation"])
    confidence = answer.confidence * expit(-gain)
    least = MatchStatus.AMBIGUOUS if undecided else MatchStatus.POOR
    status = max(answer.status, least, key=lambda one: one.rank)
    return replace(answer, status=status, confidence=confidence, candidates=(candidate, *answer.candidates))
