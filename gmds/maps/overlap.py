"""How much of both surfaces a map is about: which vertices it reaches, and the shares of their areas."""

from __future__ import annotations

import numpy as np

from geodesics import embedded, lumped_mass
from geodesics.arrays import Bools
from geodesics.intrinsic import areas, squared_lengths
from geodesics.mesh import Mesh
from gmds.maps.images import COVERED, preimage
from gmds.maps.point_map import PointMap


def covered(answer: PointMap) -> Bools:
    """Which target vertices (q,) the map reaches: those on a face, near the image of a valid face of the source.

    Near is within `COVERED` spacings of vertices: those of the target, or of the source where these are wider.
    """
    used = np.zeros(answer.target.n_vertices, dtype=bool)
    used[answer.target.faces] = True
    reached = np.zeros(len(used), dtype=bool)
    rows = np.flatnonzero(used)
    reached[rows] = preimage(answer, rows)[1] < reach(answer)
    reached.setflags(write=False)
    return reached


def reach(answer: PointMap) -> float:
    """How far from the nearest image, over sqrt(target area), a vertex of the target is still covered by it."""
    faces = answer.source.faces[answer.valid[answer.source.faces].all(axis=1)]
    image = areas(squared_lengths(answer.points.positions, faces)).sum() / answer.target.area
    images = min(image, 1.0) / max(len(np.unique(faces)), 1)  # of the target's area, where a map folds no more than all
    return float(COVERED * np.sqrt(max(1 / len(np.unique(answer.target.faces)), images)))


def covered_of(answer: PointMap) -> Bools:
    """What a map that knows says of it, as a `Correspondence` does, which computes it once; else `covered`."""
    known = getattr(answer, "covered", None)
    return covered(answer) if known is None else np.asarray(known, dtype=np.bool_)


def overlap(answer: PointMap) -> tuple[float, float]:
    """The shares in [0, 1] of the area of the source that is valid, and of that of the target that is covered."""
    return area_share(answer.source, answer.valid), area_share(answer.target, covered_of(answer))


def area_share(mesh: Mesh, vertices: Bools) -> float:
    """The share in [0, 1] of the area of a mesh that belongs to some of its vertices (n,)."""
    area = lumped_mass(embedded(mesh)).diagonal()
    return float(area[vertices].sum() / area.sum())
