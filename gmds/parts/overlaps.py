"""Where two surfaces that are both cut overlap: alignments, deformed where the other has a say."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from geodesics.threads import side_by_side
from gmds.parts.alignments import Judged, alignments
from gmds.parts.part_map import IN_PLACE, ONTO_WHOLE
from gmds.parts.search import APART
from gmds.registration.deformable import DeformableMesh
from gmds.registration.distinct import distinct
from gmds.registration.register import Registered, register, returning, settled
from gmds.registration.residuals import Residuals
from gmds.surface.measured import Surface

# Chosen on parts of SHREC'20 animals (benchmarks/results/notes.md, "Parts"), but for the sizes: set by hand.
ALIGNED = 100  # alignments that are deformed
SIZES = (0.6, 1.7)  # of the source on the target, both of unit area: the larger one has three times the area
RETURNED = 40  # of these, those whose curvature fits best, that are deformed the way back as well


@dataclass(frozen=True, eq=False)
class OverlapMap:
    """A simplified source `registered` on a simplified target, and that `back` on the source, where each has a say."""

    registered: Registered
    back: Registered | None = None

    @property
    def neg_log_likelihood(self) -> float:
        """Minus the log-likelihood up to a constant: of the curvature of what overlaps, both ways.

        Energies have no say here: the less overlaps, the less they are.
        """
        ways = [self.registered] if self.back is None else [self.registered, self.back]
        return curvature_neg_log_likelihood([way.residuals for way in ways])


def curvature_neg_log_likelihood(ways: Sequence[Residuals]) -> float:
    """Minus the log-likelihood up to a constant of the curvature alone, the mean over all ways."""
    fits = np.array([fit for one in ways for fit in (one.curvature, one.curvature_back)])
    return float(np.log(1 - np.clip(fits, 0.0, 0.999) ** 2).mean() / 2)


def overlap_maps(
    source: Surface, target: Surface, meshes: tuple[DeformableMesh, DeformableMesh], tell: Callable[[float], None]
) -> list[OverlapMap]:
    """Maps of what `source` has in common with `target`, the likeliest first; `meshes` are both simplified."""
    ours, theirs = meshes
    found = alignments(Judged(source, ours), Judged(target, theirs), SIZES, ALIGNED)
    tell(0.2)
    places = found.moved(ours.mesh.vertices)
    begun = side_by_side(lambda y: OverlapMap(settled(ours, theirs, y, IN_PLACE)), list(places))
    tell(0.6)
    likely = distinct(begun, ours.areas, APART, count=RETURNED)

    def returned(one: OverlapMap) -> OverlapMap:
        images = returning(ours, theirs, one.registered.y)
        return OverlapMap(one.registered, register(theirs, ours, images, ONTO_WHOLE))

    return distinct(side_by_side(returned, likely), ours.areas, APART)
