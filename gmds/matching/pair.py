"""What is to be matched: two measured surfaces, and what is computed of them before any map."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.caching import cached_property, memoized
from geodesics.points import joined
from geodesics.threads import side_by_side
from gmds.initialization.extremities import has_limbs
from gmds.initialization.reflection import mirror
from gmds.landmarks.constraints import LandmarkConstraints, WeightedCorners
from gmds.registration.anchors import Anchors
from gmds.registration.deformable import DeformableMesh
from gmds.registration.settings import FULL, ISOMETRIC, RegistrationSettings
from gmds.spectral.refinement import Refiner
from gmds.surface.measured import Surface

WEIGHT = 10  # samples that a hard landmark counts as when a map is extended; set by hand


@dataclass(frozen=True, eq=False)
class SurfacePair:
    """What is to be matched: two surfaces, and the `landmarks` given of the map, or None.

    `reflected`: whether the target is the mirror image of what was given, for maps that reverse orientation.
    `isometric`: whether it is known that parts keep their sizes, so that maps are refined in the metric of space.
    `contradicted`: which of the landmarks given do not go with the shapes, and by how many root areas; `given_up`: what
    those of them that are no longer among the `landmarks` cost, of negative log-likelihood.
    """

    source: Surface
    target: Surface
    landmarks: LandmarkConstraints | None = None
    reflected: bool = False
    isometric: bool = False
    contradicted: tuple[tuple[int, float], ...] = ()
    given_up: float = 0.0

    @cached_property
    def simplified(self) -> tuple[DeformableMesh, DeformableMesh]:
        """Both surfaces with few faces."""
        source, target = side_by_side(simplified, (self.source, self.target))
        return self._anchored(source, target)

    @cached_property
    def full(self) -> tuple[DeformableMesh, DeformableMesh]:
        """Both surfaces with all their faces."""
        return self._anchored(full(self.source), full(self.target))

    @property
    def settings(self) -> RegistrationSettings:
        """How the source is registered with all its faces."""
        return ISOMETRIC if self.isometric else FULL

    @cached_property
    def closed(self) -> bool:
        """Whether neither surface has a boundary."""
        return not any(mesh.boundary.any() for mesh in self.full)

    @cached_property
    def limbless(self) -> bool:
        """Whether neither surface has limbs, so that neither can be in another pose."""
        return not any(has_limbs(surface.regular) for surface in (self.source, self.target))

    def _anchored(self, source: DeformableMesh, target: DeformableMesh) -> tuple[DeformableMesh, DeformableMesh]:
        if self.landmarks is None:
            return source, target
        return anchored(self.landmarks, (self.source.mesh.vertices, self.target.mesh.vertices), source, target)

    @cached_property
    def refiner(self) -> Refiner:
        """Refines maps in the metric in which they keep area."""
        return Refiner(self.source, self.target)

    @cached_property
    def reflections(self) -> tuple[Integers | None, Integers | None]:
        """A self-map that reverses orientation of the source, or else of the target, if there is one."""
        ours = reversing(self.source)
        return ours, reversing(self.target) if ours is None else None

    def with_landmarks(self, samples: Integers, points: SurfacePoints) -> tuple[Integers, SurfacePoints]:
        """Placed samples with the hard landmarks added, often enough that the extension heeds them."""
        hard = None if self.landmarks is None else self.landmarks.hard
        if hard is None or len(hard) == 0:
            return samples, points
        ours, theirs = (np.repeat(side, WEIGHT) for side in hard.vertices)
        return np.concatenate([samples, ours]), joined(points, SurfacePoints.at_vertices(points.mesh, theirs))


@memoized
def simplified(surface: Surface) -> DeformableMesh:
    """The surface with few faces."""
    return DeformableMesh.simplified(surface)


@memoized
def full(surface: Surface) -> DeformableMesh:
    """The surface with all its faces."""
    return DeformableMesh.of(surface)


@memoized
def reversing(surface: Surface) -> Integers | None:
    """A self-map (n,) that reverses orientation, if there is one."""
    return mirror(surface, surface.regular)


def anchored(
    landmarks: LandmarkConstraints, places: tuple[Floats, Floats], source: DeformableMesh, target: DeformableMesh
) -> tuple[DeformableMesh, DeformableMesh]:
    """Both meshes, of surfaces with vertices at `places` (n, 3), (q, 3), each with anchors on the other."""
    meshes = source.mesh, target.mesh
    here, there = (
        WeightedCorners.closest(corners.positions(place), mesh.vertices, mesh.faces)
        for corners, place, mesh in zip((landmarks.source, landmarks.target), places, meshes, strict=True)
    )
    ours = Anchors(here.corners, here.weights, there.positions(meshes[1].vertices), landmarks.tolerance)
    theirs = Anchors(there.corners, there.weights, here.positions(meshes[0].vertices), landmarks.tolerance)
    return replace(source, anchors=ours), replace(target, anchors=theirs)
