"""From maps between a part and the region of a whole to a Correspondence, whichever of both the part is."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from geodesics import Mesh, SurfacePoints
from geodesics.points import joined
from geodesics.topology.edges import edges
from gmds.correspondence import Correspondence
from gmds.maps.images import preimage
from gmds.maps.point_map import Candidate, MatchStatus
from gmds.matching.laying import laid
from gmds.matching.overlaps import overlap_candidates
from gmds.matching.pair import SurfacePair
from gmds.matching.parts import PartCandidate, part_candidates
from gmds.matching.proposals import Proposal
from gmds.matching.rating import confidence_of, expected_share, status_of
from gmds.matching.result import MARGIN_OF_THE_ONLY, distortion_of, original_points
from gmds.matching.rivals import Rivals
from gmds.matching.steps import Report
from gmds.mds.losses import Loss
from gmds.provenance import versions
from gmds.surface.measured import Surface
from gmds.surface.originals import on_original

Part = Literal["source", "target", "both"]
Parts = Literal["auto", "neither", "source", "target", "both"]

EITHER: tuple[Part, ...] = ("source", "target", "both")
PARTS: tuple[Parts, ...] = ("auto", "neither", "source", "target", "both")

# A map of a part looks wrong when its negative log-likelihood is above the first, or curvature correlates by less than
# the second: right maps of the development half of the PFAUST pairs have -11.7 and 0.73 at the worst, wrong ones of
# parts of SHREC'20 animals (notes.md, "Parts") -10.3 or 0.32 at the best. Between, the confidence decides.
LEAST_LIKELY = -10.8
LEAST_CURVATURE = 0.7
# Length of one hole in root areas, above which something may be missing: the wrist of a person is 0.1 around. What is
# shorter is an eye, or a hole of a scan; of 64 parts that were cut or scanned the longest hole is 0.3 at the least.
LEAST_BOUNDARY = 0.1
# A negative log-likelihood of a map of one whole to the other, below which nothing is missing of two surfaces that are
# both open: six pairs of faces, cut below the chin, have -16.3 to -13.6, the development half of the parts of people
# and animals -10.6 to -7.4. Where one alone is open it says nothing: a body without its tail is like the whole one.
WHOLE = -13.0
FIT_OF_A_REGION = 0.3  # of log-likelihood: a surface is no part of its own copy; set by hand


@dataclass(frozen=True, eq=False)
class PartAnswer:
    """Maps of the `part` to regions of the other surface, the likeliest first."""

    part: Part
    candidates: Sequence[PartCandidate]

    @property
    def neg_log_likelihood(self) -> float:
        """That of the likeliest map."""
        return self.candidates[0].neg_log_likelihood

    def correspondence(self, meta: Mapping[str, Any]) -> Correspondence:
        """The answer."""
        return part_answer(self.candidates, self.part, meta)


def likelier_part(found: Sequence[PartAnswer], whole: Sequence[Proposal], parts: Parts) -> PartAnswer | None:
    """The likeliest of what was found of parts; None where a map of one whole to the other is as likely.

    A region can be chosen to fit, so a part has to be likelier by `FIT_OF_A_REGION`. Where both surfaces are cut, the
    less they have in common the less likely any map is, and it is enough that a map of the whole would be `POOR`. Where
    the user said which surface is the part, there is nothing to weigh.
    """
    best = min(found, key=lambda one: one.neg_log_likelihood, default=None)
    if best is None or parts != "auto":
        return best
    least = min(one.neg_log_likelihood for one in whole)
    if best.part == "both" and least > LEAST_LIKELY:
        return best
    return best if best.neg_log_likelihood < least - FIT_OF_A_REGION else None


def maps_of_parts(
    pair: SurfacePair, whole: Sequence[Proposal], parts: Parts, loss: Loss, count: int, report: Report
) -> list[PartAnswer]:
    """What comes of taking one surface for a part of the other, for each that may be; none where neither may.

    A surface without a boundary, or with short holes alone, is no part; nor is one of two open ones that fit as a
    `whole`.
    """
    sides: dict[Part, tuple[Surface, Surface]] = {
        "source": (pair.source, pair.target),
        "target": (pair.target, pair.source),
    }
    asked = _asked(sides, whole) if parts == "auto" else [name for name in EITHER if name == parts]
    found = []
    for number, name in enumerate(asked):
        tell = functools.partial(_tell, report, number / len(asked), 1 / len(asked))
        if name == "both":
            candidates = overlap_candidates(pair.source, pair.target, loss, count, tell)
        else:
            candidates = part_candidates(*sides[name], loss, count, tell)
        if candidates:
            found.append(PartAnswer(name, candidates))
    return found


def _asked(sides: Mapping[Part, tuple[Surface, Surface]], whole: Sequence[Proposal]) -> list[Part]:
    """Which of the `sides` may be parts, by their boundaries and, where both have one, by maps of the whole."""
    cut = [name for name, (part, _) in sides.items() if longest_hole(part.mesh) > LEAST_BOUNDARY]
    if len(cut) < len(sides):
        return cut
    return ["both"] if min(one.neg_log_likelihood for one in whole) > WHOLE else []


def longest_hole(mesh: Mesh) -> float:
    """The length of the edges with one face that hang together, of the longest such chain; 0 where there are none."""
    table = edges(mesh)
    ends = table.ends[table.n_faces == 1]
    if len(ends) == 0:
        return 0.0
    n = mesh.n_vertices
    chain = connected_components(coo_matrix((np.ones(len(ends)), tuple(ends.T)), (n, n)), directed=False)[1]
    lengths = np.linalg.norm(mesh.vertices[ends[:, 0]] - mesh.vertices[ends[:, 1]], axis=1)
    return float(np.bincount(chain[ends[:, 0]], lengths).max())


def _tell(report: Report, start: float, share: float, done: float) -> None:
    report("looking for the part", 0.5 + 0.5 * (start + share * done))


def part_answer(candidates: Sequence[PartCandidate], part: Part, meta: Mapping[str, Any]) -> Correspondence:
    """The likeliest map as a `Correspondence` between the original meshes, the others as its candidates.

    `candidates` map the part to regions of the whole. Where the part is the target the map is turned round: a vertex of
    the source has a counterpart when it is in the region.
    """
    best = replace(candidates[0], candidate=laid(candidates[0].candidate))
    rivals = Rivals.of([one.rank for one in candidates], [one.images.positions for one in candidates])
    forward = _rated(_forward(best, MatchStatus.UNRATED, meta), best, rivals)
    evidence = {**best.candidate.evidence.as_meta(), "margin": min(rivals.margin, MARGIN_OF_THE_ONLY)}
    others = [
        Candidate(_points(one, part), one.candidate.evidence.stress, one.candidate.evidence.orientation)
        for one in candidates[1:]
    ]
    described = {
        **meta,
        "part": part,
        "evidence": evidence,
        **best.candidate.solution.as_meta(),
        "versions": versions(),
    }
    answer = replace(forward.inverse(), valid=forward.covered) if part == "target" else forward
    return replace(answer, candidates=tuple(others), meta=described)


def _rated(forward: Correspondence, best: PartCandidate, rivals: Rivals) -> Correspondence:
    confidence = confidence_of(best.candidate, rivals)
    expected = expected_share(confidence, best.candidate.pair.full[0].areas, forward.valid)
    curvature = best.candidate.evidence.whole.curvature
    badly_kept = best.neg_log_likelihood > LEAST_LIKELY or curvature < LEAST_CURVATURE
    return replace(forward, confidence=confidence, status=status_of(expected, rivals.margin, badly_kept=badly_kept))


def _forward(one: PartCandidate, status: MatchStatus, meta: Mapping[str, Any]) -> Correspondence:
    """The map from the part to the whole."""
    part: Surface = one.candidate.pair.source
    points = one.region.on_whole(original_points(one.candidate))
    valid = part.areas > 0
    if one.elsewhere is not None:
        both, row = joined(points, on_original(one.region.whole, one.elsewhere)), np.arange(len(valid))
        points = both[np.where(valid, row, row + len(valid))]
    source = part.original if one.source_region is None else one.source_region.whole.original
    return Correspondence(
        source, one.region.whole.original, points, valid, distortion_of(one.candidate), status, (), meta
    )


def _points(one: PartCandidate, part: Part) -> SurfacePoints:
    """Where the vertices of the source go."""
    forward = _forward(one, MatchStatus.UNRATED, {})
    if part == "target":
        return preimage(forward, np.arange(forward.target.n_vertices))[0]
    return forward.points
