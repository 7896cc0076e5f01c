"""Peers that lay a surface on another in space, each from the best of rigid alignments: for shapes without limbs.

    pip install trimesh biocpd==1.3.0 meshmonk==0.3.0

Both meshes are centred and of unit area, so that a rigid motion is all that an alignment takes. ICP (`trimesh`) begins
at the 24 ways in which principal axes lie on principal axes, with the target mirrored where the map may reverse
orientation (48 then, or the 24 others), and the motion with the least mean gap both ways is its answer; the others
begin there. All of them end at the point of the target that is closest to where a vertex of the source was moved.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.closest import closest_on_triangles
from gmds.correspondence import Correspondence
from gmds.surface.measured import Surface, measured_as_it_is
from gmds.surface.originals import on_original

SPREAD = 1000  # points of each surface that rigid alignments are sought by
BEGUN, ENDED = 20, 100  # iterations of closest points from every start, and from the best
MANY = 5000  # points of each surface that biocpd takes: its kernel has as many rows and columns
FINE = 20000  # vertices of a target beyond which one is near enough: they are 0.004 root areas apart
SOME = 4000  # vertices that are moved at once: a bound on memory
AS_FACES = 200.0  # the root of the area, for meshmonk: its parameters are those of faces in millimetres
MIRROR = np.array([-1.0, 1.0, 1.0])
IMAGES = {"preserve": (1,), "reverse": (-1,), "any": (1, -1)}  # of the target: as it is, or mirrored


class Aligned(NamedTuple):
    """A source moved to `y` (n, 3) on the `target`, both in root areas; `side`: -1 where that is its mirror image."""

    source: Surface
    target: Surface
    y: Floats
    side: int

    def answer(self, y: Floats) -> Correspondence:
        """The map to the points of the target that are closest to y (n, 3); of fine meshes, to the vertices."""
        if len(self.places) > FINE:
            used = self.target.regular.usable
            points = SurfacePoints.at_vertices(self.target.mesh, used[cKDTree(self.places[used]).query(y)[1]])
        else:
            face, weight, _ = closest_on_triangles(y, self.places, self.target.mesh.faces)
            points = SurfacePoints(self.target.mesh, face, weight)
        return Correspondence.from_points(self.source.original, on_original(self.target, points))

    @property
    def places(self) -> Floats:
        """The vertices (q, 3) of the target, or of its mirror image."""
        return self.target.mesh.vertices * (MIRROR if self.side < 0 else 1.0)

    @property
    def faces(self) -> Integers:
        """Its faces, facing outward."""
        return self.target.mesh.faces if self.side > 0 else self.target.mesh.faces[:, ::-1]


def aligned(source: Mesh, target: Mesh, orientation: str = "preserve") -> Aligned:
    """The best of the rigid alignments."""
    from trimesh.registration import icp  # type: ignore[import-untyped]

    one, other = measured_as_it_is(source), measured_as_it_is(target)
    ours, found = _spread(one, SPREAD), []
    for side in IMAGES[orientation]:
        places = Aligned(one, other, one.mesh.vertices, side).places
        theirs = places[other.regular.samples(SPREAD)]
        tree = cKDTree(theirs)
        for turn in Rotation.create_group("O").as_matrix():
            start = np.eye(4)
            start[:3, :3] = _axes(theirs).T @ turn @ _axes(ours)
            start[:3, 3] = theirs.mean(axis=0) - start[:3, :3] @ ours.mean(axis=0)
            motion, moved, _ = icp(
                ours, theirs, start, threshold=0, max_iterations=BEGUN, reflection=False, scale=False
            )
            gaps = tree.query(moved)[0].mean() + cKDTree(moved).query(theirs)[0].mean()
            found.append((float(gaps), side, motion, theirs))
    _, side, motion, theirs = min(found, key=lambda one: one[0])
    motion = icp(ours, theirs, motion, threshold=0, max_iterations=ENDED, reflection=False, scale=False)[0]
    return Aligned(one, other, one.mesh.vertices @ motion[:3, :3].T + motion[:3, 3], side)


def _spread(surface: Surface, count: int) -> Floats:
    return np.asarray(surface.mesh.vertices[surface.regular.samples(count)], dtype=np.float64)


def _axes(points: Floats) -> Floats:
    """Principal axes, the rows of a rotation."""
    rows = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2]
    return np.asarray(rows * [[1.0], [1.0], [np.sign(np.linalg.det(rows))]], dtype=np.float64)


def rigid_icp(source: Mesh, target: Mesh, orientation: str = "preserve") -> Correspondence:
    """Closest points of the best rigid alignment."""
    one = aligned(source, target, orientation)
    return one.answer(one.y)


def biocpd(source: Mesh, target: Mesh, orientation: str = "preserve") -> Correspondence:
    """Coherent point drift, affine and then deformable, with biocpd's own parameters: low rank, sparse E-step."""
    from biocpd import AffineRegistration, DeformableRegistration

    one = aligned(source, target, orientation)
    x, y, every, unit = _clouds(one)
    affine = AffineRegistration(X=x, Y=y, use_kdtree=True, k=10)
    affine.register()
    y, every = (np.asarray(affine.transform_point_cloud(rows), dtype=np.float64) for rows in (y, every))
    drift = DeformableRegistration(X=x, Y=y, num_eig=min(300, len(y) - 1), use_kdtree=True, k=10)
    drift.register()
    rows = np.vstack([drift.transform_point_cloud(rows) for rows in _by_some(every)])
    return one.answer(_moved(one, rows, unit))


def _by_some(rows: Floats) -> list[Floats]:
    """In blocks, so that no kernel of all vertices has to be held."""
    return [rows[first : first + SOME] for first in range(0, len(rows), SOME)]


def _clouds(one: Aligned) -> tuple[Floats, Floats, Floats, float]:
    """Points of the target, points and all vertices of the source where it lies, of unit spread; and that spread."""
    spread = float(np.sqrt((one.places**2).mean()))
    x, y = one.places[one.target.regular.samples(MANY)], one.y[one.source.regular.samples(MANY)]
    return x / spread, y / spread, one.y / spread, spread


def _moved(one: Aligned, rows: Any, unit: float) -> Floats:
    """Back to root areas; where a peer gave no number the vertex stays."""
    y = np.asarray(rows, dtype=np.float64) * unit
    return np.where(np.isfinite(y), y, one.y)


def meshmonk(source: Mesh, target: Mesh, orientation: str = "preserve") -> Correspondence:
    """Pyramid registration, with the parameters that are meshmonk's own."""
    from meshmonk import features_from_vertices, pyramid_register

    one = aligned(source, target, orientation)
    sides = [(one.y, one.source.mesh.faces), (one.places, one.faces)]
    given = [
        (np.asarray(AS_FACES * y, dtype=np.float32), np.ascontiguousarray(faces, dtype=np.int32)) for y, faces in sides
    ]
    rows = [features_from_vertices(y, faces) for y, faces in given]
    flags = [np.ones(len(y), dtype=np.float32) for y, _ in given]
    result = pyramid_register(
        floating_features=rows[0],
        target_features=rows[1],
        floating_faces=given[0][1],
        target_faces=given[1][1],
        floating_flags=flags[0],
        target_flags=flags[1],
    )
    return one.answer(_moved(one, result.aligned_features[:, :3], 1 / AS_FACES))
