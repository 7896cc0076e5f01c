"""Two surfaces of which each is but a part: the region that each has in common with the other, and the map of it."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from geodesics import MeshError
from geodesics.arrays import Bools, Floats
from geodesics.threads import side_by_side
from gmds.matching.pair import SurfacePair, full
from gmds.matching.parts import PartCandidate, likely_candidates, matched_in, near_image
from gmds.matching.polishing import polished
from gmds.mds.losses import Loss
from gmds.parts.overlaps import curvature_neg_log_likelihood, overlap_maps
from gmds.parts.part_map import IN_PLACE
from gmds.parts.search import APART
from gmds.registration.distinct import distinct
from gmds.registration.register import Registered, settled
from gmds.registration.settings import Stage
from gmds.surface.measured import Surface
from gmds.surface.region import Region

# Set by hand, on parts of SHREC'20 animals (benchmarks/results/notes.md, "Parts").
FINALISTS = 8  # rough maps, the likeliest, for which all of both surfaces is laid on each other
MATCHED = 3  # of them, those whose regions are matched
MARGIN = 1.5  # spacings of vertices of the target around the image that belong to the region
GAP = 0.05  # root areas off the target, beyond which a vertex has no counterpart
REGION_TIME = 2e-4  # heat time, in units of the area: a region is as wide as heat spreads, as in `gmds.matching.result`

ALL_FACES = IN_PLACE.with_stages((Stage(3e-3, 4), Stage(1e-3, 4)))
"""Of both surfaces with all their faces, where each may lack what the other has."""


@dataclass(frozen=True, eq=False)
class Laid:
    """The `source` with all its faces deformed onto the `target`, as far as both are there."""

    source: Surface
    target: Surface
    registered: Registered

    @classmethod
    def of(cls, source: Surface, target: Surface, y: Floats) -> Laid:
        """From where the vertices of the source are to begin with, (n, 3)."""
        return cls(source, target, settled(full(source), full(target), y, ALL_FACES))

    @property
    def neg_log_likelihood(self) -> float:
        """That of the curvature of what overlaps."""
        return curvature_neg_log_likelihood([self.registered.residuals])

    @property
    def common(self) -> Bools:
        """Vertices (n,) of the source with a counterpart: near the target, and not nearest to its boundary."""
        ours, on_target = full(self.source), self.registered.points
        gap = np.linalg.norm(on_target.positions - self.registered.y, axis=1)
        there = ~full(self.target).on_boundary(on_target) & (gap < GAP) & (ours.areas > 0)
        return np.asarray(ours.laplacian.heat_step(REGION_TIME)(ours.areas * there) > 0.5, dtype=np.bool_)


def overlap_candidates(
    source: Surface, target: Surface, loss: Loss, count: int, report: Callable[[float], None]
) -> list[PartCandidate]:
    """Maps between what two surfaces have in common, the likeliest first; none where nothing was found."""
    meshes = SurfacePair(source, target).simplified
    rough = overlap_maps(source, target, meshes, lambda share: report(0.5 * share))
    rough = distinct(rough, meshes[0].areas, APART, count=FINALISTS)
    begun = [meshes[0].deformed(one.registered.y, source.mesh.vertices) for one in rough]
    laid = side_by_side(functools.partial(Laid.of, source, target), begun)
    laid = sorted(laid, key=lambda one: one.neg_log_likelihood)[:MATCHED]
    report(0.6)
    tried = side_by_side(lambda one: _in_regions_or_not(one, loss, count), laid)
    likely = likely_candidates([one for one in tried if one is not None])
    return likely_candidates([replace(one, candidate=polished(one.candidate)) for one in likely])


def in_regions(one: Laid, loss: Loss, count: int) -> PartCandidate:
    """The map between what both have in common. Raises `MeshError` when that shrinks to nothing (E104, E113)."""
    ours = Region.of(one.source, one.common)
    points = one.registered.points
    near = near_image(ours.surface.mesh.faces, one.target, points.positions, MARGIN)
    found = matched_in(ours.surface, Region.of(one.target, near), loss, count, points)
    return replace(found, source_region=ours, elsewhere=points)


def _in_regions_or_not(one: Laid, loss: Loss, count: int) -> PartCandidate | None:
    try:
        return in_regions(one, loss, count)
    except MeshError:  # a region is too small to be matched
        return None
