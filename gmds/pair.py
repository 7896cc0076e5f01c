"""What is to be matched: two measured surfaces, and what is known of them before any map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geodesics import SurfacePoints
from geodesics.threads import cached_property, side_by_side
from gmds.derived import derived_once
from gmds.geometry import Geometry
from gmds.known import Known
from gmds.problem import joined
from gmds.refinement import Refiner
from gmds.surface import Surface
from gmds.symmetries import mirror

Index = NDArray[np.int64]

WEIGHT = 10  # samples that a landmark is worth


@dataclass(frozen=True, eq=False)
class SurfacePair:
    """What is to be matched: two surfaces, and what is `known` of the map, or None.

    `reflected`: whether the target is the mirror image of what was given, for maps that reverse orientation.
    """

    source: Surface
    target: Surface
    known: Known | None = None
    reflected: bool = False

    @cached_property
    def outlines(self) -> tuple[Geometry, Geometry]:
        """Both surfaces with few faces."""
        source, target = side_by_side(outline, (self.source, self.target))
        return self._anchored(source, target)

    @cached_property
    def geometries(self) -> tuple[Geometry, Geometry]:
        """Both surfaces with all their faces."""
        return self._anchored(geometry(self.source), geometry(self.target))

    def _anchored(self, source: Geometry, target: Geometry) -> tuple[Geometry, Geometry]:
        if self.known is None:
            return source, target
        return self.known.anchored((self.source.mesh.vertices, self.target.mesh.vertices), source, target)

    @cached_property
    def refiner(self) -> Refiner:
        """Refines maps in the metric in which they keep area."""
        return Refiner(self.source, self.target)

    @cached_property
    def reflections(self) -> tuple[Index | None, Index | None]:
        """A self-map that reverses orientation of the source, or else of the target, if there is one."""
        ours = reversing(self.source)
        return ours, reversing(self.target) if ours is None else None

    def with_landmarks(self, samples: Index, points: SurfacePoints) -> tuple[Index, SurfacePoints]:
        """Placed samples with the hard landmarks added, often enough that the extension heeds them."""
        hard = None if self.known is None else self.known.hard
        if hard is None or len(hard) == 0:
            return samples, points
        ours, theirs = (np.repeat(side, WEIGHT) for side in hard.vertices)
        return np.concatenate([samples, ours]), joined(points, SurfacePoints.at_vertices(points.mesh, theirs))


@derived_once
def outline(surface: Surface) -> Geometry:
    """The surface with few faces."""
    return Geometry.outline(surface)


@derived_once
def geometry(surface: Surface) -> Geometry:
    """The surface with all its faces."""
    return Geometry.of(surface)


@derived_once
def reversing(surface: Surface) -> Index | None:
    """A self-map (n,) that reverses orientation, if there is one."""
    return mirror(surface, surface.regular)
