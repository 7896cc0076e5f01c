"""Which point of a deformed surface goes with which point of another: the closest, in position, normal and spectrum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from geodesics import SurfacePoints
from geodesics.threads import side_by_side, threads
from gmds._kernels.closest import nearest_candidates
from gmds.geometry import Geometry
from gmds.surface import View

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Single = NDArray[np.float32]

SPECTRAL_WEIGHT = 0.15  # root areas that root mean square eigenfunctions, all taken together, are worth
CANDIDATES = 10  # closest vertices in position and normal among which eigenfunctions decide
MANY = 2000  # vertices for which threads pay


@dataclass(frozen=True, eq=False)
class Pairing:
    """Closest points of a deformed source and a target, both ways: of every source vertex, of every usable target one.

    `weight` (n,), `weight_back` (q,): areas, or 0 where the closest point is on a boundary: what it should be paired
    with may be missing.
    """

    points: SurfacePoints
    back: Index
    weight: Array
    weight_back: Array

    @classmethod
    def of(
        cls, source: Geometry, target: Geometry, y: Array, partial: bool, views: tuple[View, View] | None = None
    ) -> Pairing:
        """The pairing with the source at y (n, 3).

        With `views`, of the undeformed surfaces, their eigenfunctions count as well: those of the source, as the
        functional map of the closest points carries them over, beside those of the target (as in ZoomOut: Melzi et al.
        2019). They keep round limbs from turning about their axis, where position and normal say nothing.
        """
        ours, theirs = source.moved_features(y), target.features
        workers = threads() if len(ours) >= MANY else 1
        if views is None:
            near = target.usable[target.tree.query(ours, workers=workers)[1]]
            back = source.usable[cKDTree(ours[source.usable]).query(theirs[target.usable], workers=workers)[1]]
        else:
            few = min(CANDIDATES, len(source.usable), len(target.usable))
            ahead = target.usable[target.tree.query(ours, k=few, workers=workers)[1]].reshape(-1, few)
            behind = source.usable[
                cKDTree(ours[source.usable]).query(theirs[target.usable], k=few, workers=workers)[1]
            ].reshape(-1, few)
            here, there = _spectral_rows(source, views, ahead[:, 0])
            ours, theirs = np.hstack([ours, here]), np.hstack([theirs, there])
            q, r = ours.astype(np.float32), theirs.astype(np.float32)
            searches = ((q, r, ahead), (r[target.usable], q, behind))
            near, back = side_by_side(lambda one: nearest_candidates(*one), searches)
        points = target.closest(ours, theirs, near)
        weight, weight_back = source.areas, target.areas[target.usable]
        if partial:
            weight = np.where(target.on_boundary(points), 0.0, weight)
            weight_back = np.where(source.boundary[back], 0.0, weight_back)
        return cls(points, back, weight, weight_back)

    def springs(self, source: Geometry, target: Geometry) -> tuple[Array, Array]:
        """Weights (n,) and ends (n, 3) of the springs that pull on vertices: to the target, and those from it."""
        place, n = target.mesh.vertices[target.usable], source.mesh.n_vertices
        weights = self.weight + np.bincount(self.back, self.weight_back, minlength=n)
        total = self.weight[:, None] * self.points.positions
        for k in range(3):
            total[:, k] += np.bincount(self.back, self.weight_back * place[:, k], minlength=n)
        return weights, total / np.maximum(weights, np.finfo(float).tiny)[:, None]


def _spectral_rows(source: Geometry, views: tuple[View, View], images: Index) -> tuple[Single, Single]:
    """Eigenfunctions (n, k), (q, k) of both surfaces as the map to `images` (n,) identifies them, weighted.

    In single precision. Column j holds target function j, and what is left of it when it is pulled back by the map and
    written in source functions.
    """
    k = min(view.functions.shape[1] for view in views)
    ours, theirs = (view.functions[:, :k].astype(np.float32) for view in views)
    weighted = theirs * np.float32(SPECTRAL_WEIGHT / np.sqrt(k))
    areas = source.areas.astype(np.float32)
    return ours @ (ours.T @ (areas[:, None] * weighted[images])), weighted
