"""From candidate maps to a Correspondence: which rows count, how far to trust it, what else there is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from geodesics import SurfacePoints
from geodesics.arrays import Bools, Floats
from gmds.correspondence import Correspondence
from gmds.maps.distortion import edge_distortion
from gmds.maps.point_map import Candidate
from gmds.matching.candidates import MapCandidate
from gmds.matching.rating import AMBIGUOUS_MARGIN, confidence_of, expected_share, status_of
from gmds.matching.rivals import Rivals
from gmds.provenance import versions
from gmds.surface.originals import on_original

# Beyond these a map looks wrong: stress (relative change of distances), correlation of mean curvature, elastic energy
# (at 1 lengths are off by about half). Set by hand.
MOST_STRESS = 0.2
LEAST_CURVATURE = 0.2
MOST_ENERGY = 1.0
MARGIN_OF_THE_ONLY = 99.0  # what stands for infinity in a file, where there is no other map
# What is off the target (by more than so many spacings of its vertices) and nearer to the boundary than so many times
# that distance lies beyond the boundary; a region is as wide as heat spreads in this time, in units of the area. Set by
# hand; what they mark with a limb cut off is in benchmarks/results/notes.md, "Trust".
OFF_SURFACE = 0.5
TO_BOUNDARY = 2.0
REGION_TIME = 2e-4
# Heat time, in units of the area, over which distortion is averaged: the rank correlation with the true error is then
# about 0.5 ("Trust"). Errors reach farther than what causes them.
DISTORTION_TIME = 1e-2


def correspondence_of(placed: Sequence[MapCandidate], meta: Mapping[str, Any]) -> Correspondence:
    """The best map as a `Correspondence` between the original meshes, the others as its candidates."""
    best = placed[0]
    source, target = best.pair.source, best.pair.target
    rivals = Rivals.of([one.neg_log_likelihood for one in placed], [one.points.positions for one in placed])
    evidence = {
        **best.evidence.as_meta(),
        "margin": min(rivals.margin, MARGIN_OF_THE_ONLY),
        "laid_in_space": best.laid is not None,
    }
    if best.pair.contradicted:
        evidence["contradicted"] = [list(one) for one in best.pair.contradicted]
    candidates = tuple(Candidate(original_points(e), e.evidence.stress, e.evidence.orientation) for e in placed[1:])
    confidence, valid = confidence_of(best, rivals), _valid(best)
    expected = expected_share(confidence, best.pair.full[0].areas, valid)
    return Correspondence(
        source=source.original,
        target=target.original,
        points=original_points(best),
        valid=valid,
        distortion=distortion_of(best),
        status=status_of(expected, rivals.margin, badly_kept=_badly_kept(best)),
        candidates=candidates,
        meta={**meta, "evidence": evidence, **best.solution.as_meta(), "versions": versions()},
        confidence=confidence,
    )


def contenders(placed: Sequence[MapCandidate]) -> list[MapCandidate]:
    """The most likely map and, if it is nearly as likely, the next: to be refined before one is chosen.

    `placed`: the most likely first. Where there is a boundary refinement has no say in which is the more likely.
    """
    best = placed[0]
    close = [
        e for e in placed[1:] if e.evidence.closed and e.neg_log_likelihood < best.neg_log_likelihood + AMBIGUOUS_MARGIN
    ]
    return [best, *close[:1]]


def original_points(candidate: MapCandidate) -> SurfacePoints:
    """The points on the original target; vertices that were left out go where the nearest one that was not went."""
    source, target, points = candidate.pair.source, candidate.pair.target, candidate.answer
    used = source.regular.usable
    row = np.arange(source.mesh.n_vertices)
    if len(used) < len(row):
        row = used[cKDTree(source.mesh.vertices[used]).query(source.mesh.vertices)[1]]
    return on_original(target, points[row])


def _valid(candidate: MapCandidate) -> Bools:
    """False (n,) at vertices of no area, and where the deformed source reaches beyond the boundary of the target.

    A vertex does when it is off the target and the boundary is hardly farther from it than the target is; so does a
    region (`REGION_TIME`) when most of it does.
    """
    (source, target), y = candidate.pair.full, candidate.final.y
    used = source.areas > 0
    edge = np.flatnonzero(target.boundary)
    if len(edge) == 0:
        return np.asarray(used, dtype=np.bool_)
    gap = np.linalg.norm(y - candidate.answer.positions, axis=1)
    to_edge = cKDTree(target.mesh.vertices[edge]).query(y)[0]
    spacing = np.sqrt(np.median(target.areas[target.usable]))
    beyond = (gap > OFF_SURFACE * spacing) & (to_edge < TO_BOUNDARY * gap)
    share = source.laplacian.heat_step(REGION_TIME)(source.areas * beyond)
    return np.asarray(used & (share < 0.5), dtype=np.bool_)


def distortion_of(candidate: MapCandidate) -> Floats:
    """By what share, in [0, 1], lengths around a vertex change (n,), see `gmds.maps.distortion`; 1 where no map is."""
    source = candidate.pair.full[0]
    change = edge_distortion(source.mesh, candidate.answer.positions)
    result = source.laplacian.heat_step(DISTORTION_TIME)(source.areas * change)
    result[source.areas <= 0] = 1.0
    return np.asarray(np.clip(result, 0.0, 1.0), dtype=np.float64)


def _badly_kept(best: MapCandidate) -> bool:
    """Whether distances, curvature or lengths are kept so badly that the map looks wrong.

    That is said of maps that were registered: what was not keeps lengths worse, right or wrong.
    """
    if best.is_plain:
        return False
    whole = best.evidence.whole
    return best.evidence.stress > MOST_STRESS or whole.curvature < LEAST_CURVATURE or whole.energy > MOST_ENERGY
