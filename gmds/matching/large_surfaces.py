"""Large surfaces: matched as copies with fewer vertices, and the map prolonged to all of them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.barycentric import combination
from geodesics.caching import memoized
from geodesics.closest import closest_on_triangles
from geodesics.repair.decimation import decimated
from geodesics.threads import threads
from gmds.correspondence import Correspondence
from gmds.landmarks.constraints import LandmarkConstraints, WeightedCorners
from gmds.maps.point_map import Candidate
from gmds.registration.deformable import DeformableMesh
from gmds.spectral.orientation import orientation_score
from gmds.surface.measured import Surface, measured_as_it_is, on_original

# Vertices of the copy, and those up to which a surface is matched as it is: whole SHREC'20 animals take 13 CPU seconds
# as copies instead of 31 (benchmarks/results/notes.md, "Speed of a match").
WORKING = 5000
LARGE = 8000


def copied(surface: Surface, n_vertices: int) -> Surface:
    """A copy of a surface with about so many vertices; itself where that cannot be made.

    The mesh it was measured from, its `original`, lies where that of the surface does.
    """
    mesh = decimated(surface.mesh, 2 * n_vertices)
    return surface if mesh is None else measured_as_it_is(mesh)


@memoized
def coarse(surface: Surface) -> Surface:
    """What is matched of a surface: a copy with some `WORKING` vertices where it has more than `LARGE`, or itself."""
    large = len(np.unique(surface.mesh.faces)) > LARGE
    return copied(surface, WORKING) if large else surface


@dataclass(frozen=True, eq=False)
class CoarseCopies:
    """The `copies` of two surfaces that are matched in their place, each a copy or the surface itself."""

    source: Surface
    target: Surface
    copies: tuple[Surface, Surface]

    @classmethod
    def of(cls, source: Surface, target: Surface) -> CoarseCopies | None:
        """The copies of two surfaces that are matched; None where there are no copies."""
        copies = coarse(source), coarse(target)
        return None if copies == (source, target) else cls(source, target, copies)

    def landmarks(self, landmarks: LandmarkConstraints) -> LandmarkConstraints:
        """Corresponding points of the surfaces as those of their copies that are closest."""
        ours, theirs = (
            WeightedCorners.closest(corners.positions(surface.mesh.vertices), places, copy.mesh.faces)
            for surface, copy, places, corners in zip(
                (self.source, self.target), self.copies, self._places, (landmarks.source, landmarks.target), strict=True
            )
        )
        return LandmarkConstraints(ours, theirs, landmarks.tolerance)

    def prolonged(self, answer: Correspondence) -> Correspondence:
        """A map between the copies as one between the whole surfaces.

        A vertex goes with the point of the copy that it is closest to, and from there to the closest point, in position
        and normal, of the whole target. Candidates go the same way.
        """
        face, weights, _ = closest_on_triangles(self.source.mesh.vertices, self._places[0], answer.source.faces)
        corners = answer.source.faces[face]
        share = combination(weights, answer.valid[corners].astype(np.float64))
        used = np.zeros(self.source.mesh.n_vertices, dtype=bool)
        used[np.unique(self.source.mesh.faces)] = True
        return Correspondence(
            source=self.source.original,
            target=self.target.original,
            points=self._sent(answer.points, corners, weights),
            valid=used & (share > 0.5),
            distortion=combination(weights, answer.distortion[corners]),
            confidence=combination(weights, answer.confidence[corners]),
            status=answer.status,
            candidates=tuple(self._candidate(one, corners, weights) for one in answer.candidates),
            meta={**answer.meta, "solved_vertices": [copy.mesh.n_vertices for copy in self.copies]},
        )

    @property
    def _places(self) -> tuple[Floats, Floats]:
        """The vertices of the meshes that the copies were measured from, where the surfaces are."""
        ours, theirs = (
            surface.mesh.vertices if copy is surface else copy.original.vertices
            for surface, copy in zip((self.source, self.target), self.copies, strict=True)
        )
        return ours, theirs

    def _candidate(self, one: Candidate, corners: Integers, weights: Floats) -> Candidate:
        return replace(one, points=self._sent(one.points, corners, weights))

    def _sent(self, points: SurfacePoints, corners: Integers, weights: Floats) -> SurfacePoints:
        """Where weighted corners (n, 3) of the copy of the source go on the whole target, if `points` is the map."""
        here, there = _whole(self.source), _whole(self.target)
        ends = points.interpolate(self._places[1])
        y = combination(weights, ends[corners])
        features = here.moved_features(y)
        turned = orientation_score(here.mesh, there.mesh, y, there.normals[there.places.query(y, workers=threads())[1]])
        features[:, 3:] *= np.sign(turned) or 1.0
        near = there.usable[there.tree.query(features, workers=threads())[1]]
        return on_original(self.target, there.closest(features, there.features, near))


@memoized
def _whole(surface: Surface) -> DeformableMesh:
    """All of a surface; maps are prolonged without its curvature."""
    n = surface.mesh.n_vertices
    return DeformableMesh(surface.mesh, np.arange(n), np.zeros(n))
