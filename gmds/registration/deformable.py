"""A surface as registration sees it: vertices, normals, and what it costs to bend it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.barycentric import combination
from geodesics.caching import cached_property, memoized
from geodesics.closest import closest_on_triangles
from geodesics.one_ring import one_ring_areas
from geodesics.repair.decimation import decimated
from geodesics.topology.components import boundary_vertices
from geodesics.topology.edges import proper_faces
from gmds._kernels.closest import closest_on_faces, nearest_around
from gmds._kernels.deformation import positions_and_normals
from gmds.registration.anchors import Anchors
from gmds.registration.energies import Energy, EnergyKind
from gmds.registration.laplacian import CotangentLaplacian
from gmds.surface.measured import Surface

SIMPLIFIED_FACES = 1600  # one registration then takes 0.05 CPU seconds, and all proposals can be weighed; set by hand
# Root areas that a right angle between normals counts as, over root 2: 0.03 and 0.3 were worse on development pairs
# (benchmarks/results/notes.md, "Deforming the source").
NORMAL_WEIGHT = 0.1
LOOKS = 4  # from vertex to vertex for the closest point, at the most; set by hand
LEAST_SHARE = 1e-6  # of the area, around a vertex: a bound, so that a logarithm is finite
STEPS = 2  # from vertex to vertex for the closest vertex, at the most ("Faster by a third" says what that saves)


@dataclass(frozen=True, eq=False)
class DeformableMesh:
    """A mesh of unit area, and for each vertex the vertex `origin` (n,) it stands for on the surface it was made of.

    `curvature` (n,): squashed mean curvature, which distinguishes the chest from the back. `anchors`:
    where landmarks belong on the surface it is registered to.
    """

    mesh: Mesh
    origin: Integers
    curvature: Floats
    anchors: Anchors | None = None

    @classmethod
    def of(cls, surface: Surface) -> DeformableMesh:
        """The whole surface."""
        return cls(surface.mesh, np.arange(surface.mesh.n_vertices), surface.squashed_curvature)

    @classmethod
    def simplified(cls, surface: Surface, n_faces: int = SIMPLIFIED_FACES) -> DeformableMesh:
        """The surface with about `n_faces` faces, by collapsing edges; the whole where that cannot be done."""
        mesh = decimated(surface.mesh, n_faces)
        if mesh is None:
            return cls.of(surface)
        used = np.unique(surface.mesh.faces[proper_faces(surface.mesh.faces)])
        origin = used[cKDTree(surface.mesh.vertices[used]).query(mesh.vertices)[1]]
        return cls(mesh, origin, surface.squashed_curvature[origin])

    @cached_property
    def usable(self) -> Integers:
        """Vertices with area."""
        return np.flatnonzero(self.areas > 0)

    @cached_property
    def boundary(self) -> Bools:
        """Whether a vertex (n,) is on an edge of a single face."""
        return boundary_vertices(self.mesh)

    def on_boundary(self, points: SurfacePoints) -> Bools:
        """Whether points (p,) of the surface lie on its boundary."""
        inside = np.where(self.boundary[self.mesh.faces[points.face]], 0.0, points.barycentric)
        return np.asarray(inside.sum(axis=1) <= 0, dtype=np.bool_)

    @cached_property
    def areas(self) -> Floats:
        """Area (n,) around each vertex; the sum is 1."""
        areas = one_ring_areas(self.mesh)
        return np.asarray(areas / areas.sum(), dtype=np.float64)

    def areas_at(self, y: Floats) -> Floats:
        """A third of the faces around each vertex (n,) when the vertices are at y (n, 3); the sum is 1."""
        a, b, c = (y[corner] for corner in self.mesh.faces.T)
        faces = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        areas = np.bincount(self.mesh.faces.ravel(), np.repeat(faces, 3), self.mesh.n_vertices)
        return np.asarray(areas / max(areas.sum(), np.finfo(float).tiny), dtype=np.float64)

    def log_growth(self, y: Floats, time: float) -> Floats:
        """The logarithm of how much larger the area around each vertex (n,) is with the vertices at y (n, 3).

        Both areas, as shares of the whole, are smoothed by an implicit heat step of `time`, in units of the area.
        """
        now, before = (self.laplacian.heat_step(time)(areas) for areas in (self.areas_at(y), self.areas))
        return np.asarray(np.log(np.maximum(now, LEAST_SHARE) / np.maximum(before, LEAST_SHARE)), dtype=np.float64)

    @cached_property
    def laplacian(self) -> CotangentLaplacian:
        """Its Laplacian, of which the energies are made."""
        return CotangentLaplacian(self.mesh, self.areas)

    @memoized
    def energy(self, kind: EnergyKind) -> Energy:
        """What it costs to deform it, by an energy of this kind."""
        return kind(self.laplacian)

    @cached_property
    def normals(self) -> Floats:
        """Unit normals (n, 3), means over the faces around each vertex weighted by area."""
        return self.features[:, 3:] / NORMAL_WEIGHT

    @cached_property
    def features(self) -> Floats:
        """Positions and weighted normals (n, 6)."""
        return self.moved_features(self.mesh.vertices)

    def moved_features(self, y: Floats) -> Floats:
        """The features (n, 6) after moving the vertices to y (n, 3)."""
        return positions_and_normals(self.mesh.faces, y, NORMAL_WEIGHT)

    def moved_normals(self, y: Floats) -> Floats:
        """Unit normals (n, 3) after moving the vertices to y (n, 3)."""
        return self.moved_features(y)[:, 3:] / NORMAL_WEIGHT

    @cached_property
    def _around(self) -> sp.csr_matrix:
        """Sums over the faces around each vertex, (n, m)."""
        n, m = self.mesh.n_vertices, self.mesh.n_faces
        rows = np.repeat(np.arange(m), 3)
        return sp.csr_matrix((np.ones(3 * m), (self.mesh.faces.ravel(), rows)), shape=(n, m))

    @cached_property
    def tree(self) -> cKDTree:
        """Search tree of the features of the usable vertices."""
        return cKDTree(self.features[self.usable])

    @cached_property
    def places(self) -> cKDTree:
        """Search tree of the vertices in space."""
        return cKDTree(self.mesh.vertices)

    @cached_property
    def _rings(self) -> tuple[Integers, Integers]:
        """Faces of each vertex, one after the other, and where those of a vertex start."""
        corners = self.mesh.faces.ravel()
        counts = np.bincount(corners, minlength=self.mesh.n_vertices)
        return np.argsort(corners, kind="stable") // 3, np.concatenate([[0], np.cumsum(counts)])

    @cached_property
    def _neighbours(self) -> tuple[Integers, Integers]:
        """Vertices on a face with each vertex, one after the other, and where those of a vertex start."""
        together = sp.csr_matrix(self._around @ self._around.T)
        return together.indices.astype(np.int64), together.indptr.astype(np.int64)

    def closest(self, queries: Floats, rows: Floats, guess: Integers) -> SurfacePoints:
        """Points of the surface, embedded by `rows` (n, k), closest to `queries` (p, k), near the vertices `guess`."""
        q, r = np.ascontiguousarray(queries), np.ascontiguousarray(rows)
        face, weight, _ = closest_on_faces(q, r, self.mesh.faces, *self._rings, guess, LOOKS)
        return SurfacePoints(self.mesh, face, weight)

    def nearest(self, queries: Floats, rows: Floats, guess: Integers) -> Integers:
        """Vertices, embedded by `rows` (n, k), closest to `queries` (p, k), near the vertices `guess` (p,)."""
        return nearest_around(queries.astype(np.float32), rows.astype(np.float32), *self._neighbours, guess, STEPS)

    def deformed(self, y: Floats, points: Floats) -> Floats:
        """Where points (p, 3) on the surface go when its vertices go to y (n, 3)."""
        face, weight, _ = closest_on_triangles(points, self.mesh.vertices, self.mesh.faces)
        return combination(weight, y[self.mesh.faces[face]])
