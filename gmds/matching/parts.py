"""A part of a surface on a whole one: the region that it covers and the map find each other, in turn."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from geodesics import MeshError, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.closest import closest_on_triangles
from geodesics.threads import side_by_side
from gmds.matching.candidates import MapCandidate, make_candidate, registered
from gmds.matching.evidence import evidence
from gmds.matching.pair import SurfacePair
from gmds.matching.polishing import polished
from gmds.matching.proposals import Proposal
from gmds.mds.losses import Loss
from gmds.parts.search import part_maps
from gmds.surface.measured import Surface
from gmds.surface.region import Region

FINALISTS = 3  # rough maps for which a region is sought
# Spacings of vertices around the image of the part that belong to its region, round by round: the image comes out too
# small where the map still slides, and what is cut off once is lost. 2, 1.5, 1, 0.75 lost a third of the pairs of the
# development half, 2, 1.5, 1.5 none.
MARGINS = (2.0, 1.5, 1.5)
SHORTFALL = 1.5  # of log-likelihood from the best, beyond which a map is not followed into the next round


@dataclass(frozen=True, eq=False)
class PartCandidate:
    """A map of a part, or of a `source_region` beyond which vertices go `elsewhere`, to a region of a whole."""

    candidate: MapCandidate
    region: Region
    source_region: Region | None = None
    elsewhere: SurfacePoints | None = None

    @property
    def images(self) -> SurfacePoints:
        """Where the vertices of the part (n,) go on the measured whole."""
        return self.region.on_measured(self.candidate.points)

    @property
    def neg_log_likelihood(self) -> float:
        """That of the map between the simplified part and the simplified region, as for maps of a whole to a whole."""
        return self.candidate.evidence.neg_log_likelihood

    @property
    def rank(self) -> float:
        """Among maps of one part, all of it has a say as well: in its own region nothing is missing."""
        return self.neg_log_likelihood + self.candidate.evidence.whole.neg_log_likelihood


def part_candidates(
    source: Surface, target: Surface, loss: Loss, count: int, report: Callable[[float], None]
) -> list[PartCandidate]:
    """Maps of the part `source` to regions of `target`, the likeliest first; none where nothing was found."""
    pair = SurfacePair(source, target)
    rough = part_maps(source, target, pair.simplified, lambda share: report(0.4 * share))
    begun: list[SurfacePoints] = []
    done: list[PartCandidate] = []
    for one in rough[:FINALISTS]:
        y = pair.simplified[0].deformed(one.registered.y, source.mesh.vertices)
        mesh, features = pair.full[1], pair.full[0].moved_features(y)
        begun.append(SurfacePoints.at_vertices(target.mesh, mesh.usable[mesh.tree.query(features)[1]]))

    for number, margin in enumerate(MARGINS):
        tried = side_by_side(functools.partial(_in_region_or_not, source, target, margin, loss, count), begun)
        likely = likely_candidates([one for one in tried if one is not None])
        done = likely_candidates(side_by_side(lambda one: replace(one, candidate=polished(one.candidate)), likely))
        begun = [one.images for one in done]
        report(0.4 + 0.6 * (number + 1) / len(MARGINS))
    return done


def likely_candidates(candidates: Sequence[PartCandidate]) -> list[PartCandidate]:
    """The likeliest first, without those that fall short of it by much."""
    ranked = sorted(candidates, key=lambda one: one.rank)
    return [one for one in ranked if one.rank < ranked[0].rank + SHORTFALL]


def in_region(
    source: Surface, target: Surface, margin: float, loss: Loss, count: int, images: SurfacePoints
) -> PartCandidate:
    """The map of a part that sends vertices to about `images` (n,) on the target, and the region that it covers.

    The target is cut down to what is within `margin` spacings of the image, and the part is matched with that. Raises
    `MeshError` when the region shrinks to nothing (E104, E113).
    """
    near = near_image(source.mesh.faces, target, images.positions, margin)
    return matched_in(source, Region.of(target, near), loss, count, images)


def matched_in(source: Surface, region: Region, loss: Loss, count: int, images: SurfacePoints) -> PartCandidate:
    """The map of the source to a region, from `images` (n,) on the whole of that."""
    pair = SurfacePair(source, region.surface, None, source.reverses != region.whole.reverses)
    places = region.surface.mesh.vertices[images.nearest_vertices()[pair.simplified[0].origin]]
    candidate = make_candidate(pair, Proposal.of(pair, places), loss, count)
    vertices, usable = region.surface.mesh.vertices, pair.full[1].usable
    near = usable[cKDTree(vertices[usable]).query(vertices[images.nearest_vertices()])[1]]
    direct = registered(pair, SurfacePoints.at_vertices(region.surface.mesh, near))
    if direct.residuals.cost < candidate.deformation.residuals.cost:  # holes of the part may mislead eigenfunctions
        weighed = evidence(pair, candidate.views, direct.points, candidate.evidence.both_simplified, direct.residuals)
        candidate = replace(candidate, points=direct.points, deformation=direct, evidence=weighed)
    return PartCandidate(candidate, region)


def _in_region_or_not(*arguments: Any) -> PartCandidate | None:
    try:
        return in_region(*arguments)
    except MeshError:  # the region is too small to be matched
        return None


def near_image(faces: Integers, target: Surface, positions: Floats, margin: float) -> Bools:
    """Vertices (q,) of the target within `margin` spacings of the image of `faces`, whose vertices are there."""
    spacing = np.sqrt(np.median(target.areas[target.regular.usable]))
    gap = closest_on_triangles(target.mesh.vertices, positions, faces)[2]
    return np.asarray(gap < margin * spacing, dtype=np.bool_)
