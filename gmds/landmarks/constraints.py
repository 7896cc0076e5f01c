"""Landmarks as the parts of matching use them: pairs of points, each with a tolerance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.barycentric import combination
from geodesics.closest import closest_on_triangles


@dataclass(frozen=True, eq=False)
class WeightedCorners:
    """Points of a surface as `corners` (k, 3), its vertices, with `weights` (k, 3): whichever way its faces turn."""

    corners: Integers
    weights: Floats

    @classmethod
    def of(cls, points: SurfacePoints) -> WeightedCorners:
        """The points of a mesh."""
        return cls(points.mesh.faces[points.face], points.barycentric)

    @classmethod
    def closest(cls, places: Floats, vertices: Floats, faces: Integers) -> WeightedCorners:
        """The points of a mesh that are closest to places (k, 3)."""
        face, weights, _ = closest_on_triangles(places, vertices, faces)
        return cls(faces[face], weights)

    def positions(self, vertices: Floats) -> Floats:
        """Where they are (k, 3)."""
        return combination(self.weights, vertices[self.corners])

    @property
    def vertices(self) -> Integers:
        """The heaviest corners (k,)."""
        return self.corners[np.arange(len(self.corners)), self.weights.argmax(axis=1)]

    def __getitem__(self, rows: Integers | Bools) -> WeightedCorners:
        return WeightedCorners(self.corners[rows], self.weights[rows])


@dataclass(frozen=True, eq=False)
class LandmarkConstraints:
    """Corresponding points of two surfaces, k each, and the `tolerance` (k,) in root areas: 0 for hard landmarks.

    `rows` (k,): which of the landmarks that were given they are.
    """

    source: WeightedCorners
    target: WeightedCorners
    tolerance: Floats
    rows: Integers

    def __getitem__(self, rows: Integers | Bools) -> LandmarkConstraints:
        return LandmarkConstraints(self.source[rows], self.target[rows], self.tolerance[rows], self.rows[rows])

    def __len__(self) -> int:
        return len(self.tolerance)

    @property
    def hard(self) -> LandmarkConstraints:
        """Those that hold exactly."""
        return self[self.tolerance <= 0]

    @property
    def vertices(self) -> tuple[Integers, Integers]:
        """The vertices nearest to them on both surfaces, none of them twice."""
        rows = np.stack([self.source.vertices, self.target.vertices], axis=1)
        for column in range(2):
            rows = rows[np.sort(np.unique(rows[:, column], return_index=True)[1])]
        return rows[:, 0], rows[:, 1]

    def within(self, source: Integers, target: Integers) -> LandmarkConstraints | None:
        """Those that lie on these faces of both surfaces, if any do."""
        ours, theirs = np.isin(self.source.vertices, source), np.isin(self.target.vertices, target)
        return self[ours & theirs] if (ours & theirs).any() else None

    def miss(self, points: SurfacePoints, vertices: Floats) -> float:
        """Mean distance of the images from where they belong, for a map to points (n,), of vertices (q, 3)."""
        gap = self.source.positions(points.positions) - self.target.positions(vertices)
        return float(np.linalg.norm(gap, axis=1).mean())
