"""What is known of a map beforehand: landmarks, as the parts of matching see them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geodesics import SurfacePoints
from geodesics.closest import closest_on_triangles
from gmds.anchors import Anchors
from gmds.geometry import Geometry

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Faces = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Marks:
    """Points of a surface as `corners` (k, 3), its vertices, with `weights` (k, 3): whichever way its faces turn."""

    corners: Index
    weights: Array

    @classmethod
    def of(cls, points: SurfacePoints) -> Marks:
        """The points of a mesh."""
        return cls(points.mesh.faces[points.face], points.barycentric)

    @classmethod
    def closest(cls, places: Array, vertices: Array, faces: Faces) -> Marks:
        """The points of a mesh that are closest to places (k, 3)."""
        face, weights, _ = closest_on_triangles(places, vertices, faces)
        return cls(faces[face], weights)

    def positions(self, vertices: Array) -> Array:
        """Where they are (k, 3)."""
        return np.asarray(np.einsum("kc,kcj->kj", self.weights, vertices[self.corners]), dtype=np.float64)

    @property
    def vertices(self) -> Index:
        """The heaviest corners (k,)."""
        return self.corners[np.arange(len(self.corners)), self.weights.argmax(axis=1)]

    def __getitem__(self, rows: Index | NDArray[np.bool_]) -> Marks:
        return Marks(self.corners[rows], self.weights[rows])


@dataclass(frozen=True, eq=False)
class Known:
    """Corresponding points of two surfaces, k each, and the `tolerance` (k,) in root areas: 0 for hard landmarks."""

    source: Marks
    target: Marks
    tolerance: Array

    def __getitem__(self, rows: Index | NDArray[np.bool_]) -> Known:
        return Known(self.source[rows], self.target[rows], self.tolerance[rows])

    def __len__(self) -> int:
        return len(self.tolerance)

    @property
    def hard(self) -> Known:
        """Those that hold exactly."""
        return self[self.tolerance <= 0]

    @property
    def vertices(self) -> tuple[Index, Index]:
        """The vertices nearest to them on both surfaces, none of them twice."""
        rows = np.stack([self.source.vertices, self.target.vertices], axis=1)
        for column in range(2):
            rows = rows[np.sort(np.unique(rows[:, column], return_index=True)[1])]
        return rows[:, 0], rows[:, 1]

    def within(self, source: Faces, target: Faces) -> Known | None:
        """Those that lie on these faces of both surfaces, if any do."""
        ours, theirs = np.isin(self.source.vertices, source), np.isin(self.target.vertices, target)
        return self[ours & theirs] if (ours & theirs).any() else None

    def anchored(self, places: tuple[Array, Array], source: Geometry, target: Geometry) -> tuple[Geometry, Geometry]:
        """Both geometries, of surfaces with vertices at `places` (n, 3), (q, 3), each with anchors on the other."""
        meshes = source.mesh, target.mesh
        here, there = (
            Marks.closest(marks.positions(place), mesh.vertices, mesh.faces)
            for marks, place, mesh in zip((self.source, self.target), places, meshes, strict=True)
        )
        ours = Anchors(here.corners, here.weights, there.positions(meshes[1].vertices), self.tolerance)
        theirs = Anchors(there.corners, there.weights, here.positions(meshes[0].vertices), self.tolerance)
        return replace(source, anchors=ours), replace(target, anchors=theirs)

    def miss(self, points: SurfacePoints, vertices: Array) -> float:
        """Mean distance of the images from where they belong, for a map to points (n,), of vertices (q, 3)."""
        gap = self.source.positions(points.positions) - self.target.positions(vertices)
        return float(np.linalg.norm(gap, axis=1).mean())
