"""A region of a measured surface, measured as a surface of its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Integers
from geodesics.caching import cached_property
from gmds.surface.measured import Surface, measured_as_it_is
from gmds.surface.originals import turned_back


@dataclass(frozen=True, eq=False)
class Region:
    """The largest part of some of the faces of a surface, as a `surface` with the same vertices.

    Its mesh has the rows `faces` (m,) of those of the original of the whole.
    """

    whole: Surface
    surface: Surface
    faces: Integers

    @classmethod
    def of(cls, whole: Surface, vertices: Bools) -> Region:
        """The faces of which all corners are among the `vertices` (n,). Raises `MeshError` (E104, E113)."""
        faces = whole.face_index[vertices[whole.mesh.faces].all(axis=1)]
        part = Mesh(whole.original.vertices, whole.original.faces[faces])
        measured = measured_as_it_is(part, reflected=whole.reflected)
        return cls(whole, measured.inside_out if whole.turned else measured, faces)

    def on_measured(self, points: SurfacePoints) -> SurfacePoints:
        """Points of the measured region as points of the measured whole."""
        face = self._row[points.face]
        weights = turned_back(points.barycentric, self.surface.mesh.faces[points.face], self.whole.mesh.faces[face])
        return SurfacePoints(self.whole.mesh, face, weights)

    @cached_property
    def _row(self) -> Integers:
        """For each face of the measured region the face of the measured whole."""
        row = np.zeros(self.whole.original.n_faces, dtype=np.int64)
        row[self.whole.face_index] = np.arange(len(self.whole.face_index))
        return np.asarray(row[self.faces[self.surface.face_index]], dtype=np.int64)

    def on_whole(self, points: SurfacePoints) -> SurfacePoints:
        """Points of the original of the region as points of the original of the whole."""
        return SurfacePoints(self.whole.original, self.faces[points.face], points.barycentric)
