"""Large surfaces: matched as copies with fewer vertices, and the map prolonged to all of them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.barycentric import combination
from geodesics.caching import memoized
from geodesics.closest import closest_on_triangles
from geodesics.repair.decimation import decimated
from geodesics.threads import side_by_side, threads
from gmds.correspondence import Correspondence
from gmds.landmarks.constraints import LandmarkConstraints, WeightedCorners
from gmds.maps.point_map import Candidate
from gmds.registration.contacts import on_the_sheets_of, taken_back
from gmds.registration.deformable import DeformableMesh
from gmds.registration.register import settled
from gmds.registration.settings import AFFINE_AGAIN
from gmds.spectral.orientation import orientation_score
from gmds.surface.measured import Surface, measured_as_it_is
from gmds.surface.originals import on_original

# Vertices of the copy, and those up to which a surface is matched as it is: whole SHREC'20 animals take 13 CPU seconds
# as copies instead of 31 (benchmarks/results/notes.md, "Speed of a match").
WORKING = 5000
LARGE = 8000
MOST_LAID = 200_000  # vertices of a source that is laid in space with all of them: 80,000 take 6 CPU s; set by hand
MIRROR = (-1.0, 1.0, 1.0)


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
        ours, theirs = side_by_side(coarse, (source, target))
        return None if (ours, theirs) == (source, target) else cls(source, target, (ours, theirs))

    def landmarks(self, landmarks: LandmarkConstraints) -> LandmarkConstraints:
        """Corresponding points of the surfaces as those of their copies that are closest."""
        ours, theirs = (
            WeightedCorners.closest(corners.positions(surface.mesh.vertices), places, copy.mesh.faces)
            for surface, copy, places, corners in zip(
                (self.source, self.target), self.copies, self._places, (landmarks.source, landmarks.target), strict=True
            )
        )
        return replace(landmarks, source=ours, target=theirs)

    def prolonged(self, answer: Correspondence) -> Correspondence:
        """A map between the copies as one between the whole surfaces.

        A vertex goes with the closest point of the copy on the sheet that it is on, and from there to the closest
        point, in position and normal, of the whole target, on the sheet of it that the copy is sent to. Candidates go
        the same way. Where the copy was laid in space, all of the source is laid there once more, if it has at most
        `MOST_LAID` vertices.
        """
        on_copy = self._on_copy(answer.source.faces)
        face, weights = on_copy.face, on_copy.barycentric
        corners = answer.source.faces[face]
        share = combination(weights, answer.valid[corners].astype(np.float64))
        laid = answer.meta.get("evidence", {}).get("laid_in_space", False) and len(face) <= MOST_LAID
        sent = self._laid if laid else self._sent
        used = np.zeros(self.source.mesh.n_vertices, dtype=bool)
        used[np.unique(self.source.mesh.faces)] = True
        return Correspondence(
            source=self.source.original,
            target=self.target.original,
            points=sent(answer.points, corners, weights),
            valid=used & (share > 0.5),
            distortion=combination(weights, answer.distortion[corners]),
            confidence=combination(weights, answer.confidence[corners]),
            status=answer.status,
            candidates=tuple(self._candidate(one, corners, weights) for one in answer.candidates),
            meta={**answer.meta, "solved_vertices": [copy.mesh.n_vertices for copy in self.copies]},
        )

    def _on_copy(self, faces: Integers) -> SurfacePoints:
        """Where the vertices of the source are on its copy with these `faces` (m, 3)."""
        places, copy = self.source.mesh.vertices, Mesh(self._places[0], faces)
        points = SurfacePoints(copy, *closest_on_triangles(places, copy.vertices, faces)[:2])
        return taken_back(_whole(self.source), _whole_of(copy), places, points)

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
        here, there, y = self._moved(points, corners, weights)
        features = here.moved_features(y)
        near = there.usable[there.tree.query(features, workers=threads())[1]]
        if self.copies[1] is not self.target:
            copy = _whole_of(Mesh(self._places[1], points.mesh.faces))
            images = points.nearest_vertices()[np.take_along_axis(corners, weights.argmax(axis=1)[:, None], 1)[:, 0]]
            near = on_the_sheets_of(images, copy, near, there)
        return on_original(self.target, there.closest(features, there.features, near))

    def _laid(self, points: SurfacePoints, corners: Integers, weights: Floats) -> SurfacePoints:
        """The same, of a source that lies there nearly as it is."""
        return on_original(self.target, settled(*self._moved(points, corners, weights), AFFINE_AGAIN).points)

    def _moved(
        self, points: SurfacePoints, corners: Integers, weights: Floats
    ) -> tuple[DeformableMesh, DeformableMesh, Floats]:
        """All of the source, mirrored if the map `points` mirrors it, all of the target, and where the one lies."""
        here, there = _whole(self.source), _whole(self.target)
        y = combination(weights, points.interpolate(self._places[1])[corners])
        normals = there.normals[there.places.query(y, workers=threads())[1]]
        if orientation_score(here.mesh, there.mesh, y, normals) < 0:
            here = _whole_of(Mesh(here.mesh.vertices * MIRROR, here.mesh.faces[:, ::-1]))
        return here, there, y


@memoized
def _whole(surface: Surface) -> DeformableMesh:
    """All of a surface; maps are prolonged without its curvature."""
    return _whole_of(surface.mesh)


def _whole_of(mesh: Mesh) -> DeformableMesh:
    return DeformableMesh(mesh, np.arange(mesh.n_vertices), np.zeros(mesh.n_vertices))
