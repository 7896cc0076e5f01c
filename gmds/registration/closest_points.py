"""Which point of a deformed surface goes with which point of another: the closest, in position, normal and spectrum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from geodesics import SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.threads import both
from gmds._kernels.deformation import weighted_goals
from gmds.registration.deformable import DeformableMesh
from gmds.registration.settings import RegistrationSettings
from gmds.surface.view import View

Single = NDArray[np.float32]

# Root areas that eigenfunctions of root mean square 1, all taken together, count as: 0.3 is no better on development
# pairs (benchmarks/results/notes.md, "Eigenfunctions in the registration").
SPECTRAL_WEIGHT = 0.15


@dataclass(frozen=True, eq=False)
class ClosestPoints:
    """Closest points of a deformed source and a target, both ways: of every source vertex, of every usable target one.

    `points` (n,) of the target, with the vertices `near` (n,) them; vertices `back` (q,) of the source.
    `weight` (n,), `weight_back` (q,): areas, or 0 where the closest point is on a boundary: what it should be paired
    with may be missing.
    """

    points: SurfacePoints
    near: Integers
    back: Integers
    weight: Floats
    weight_back: Floats

    @classmethod
    def of(
        cls,
        source: DeformableMesh,
        target: DeformableMesh,
        y: Floats,
        settings: RegistrationSettings,
        before: ClosestPoints | None = None,
    ) -> ClosestPoints:
        """The closest points with the source at y (n, 3); after a small move, near those `before` it.

        With the `views` of the settings eigenfunctions count as well: those of the source, pulled back by the
        functional map of the closest points, beside those of the target (as in ZoomOut: Melzi et al. 2019). They keep
        round limbs from turning about their axis, where position and normal say nothing.
        """
        ours, theirs = source.moved_features(y), target.features
        if before is None:
            near, back = both(
                lambda: target.usable[target.tree.query(ours)[1]],
                lambda: source.usable[cKDTree(ours[source.usable]).query(theirs[target.usable])[1]],
            )
        else:
            near = target.nearest(ours, theirs, before.near)
            back = source.nearest(theirs[target.usable], ours, before.back)
        if settings.views is not None:
            here, there = _spectral_rows(source, settings.views, near)
            ours, theirs = np.hstack([ours, here]), np.hstack([theirs, there])
            near, back = target.nearest(ours, theirs, near), source.nearest(theirs[target.usable], ours, back)
        points = target.closest(ours, theirs, near)
        weight, weight_back = source.areas, target.areas[target.usable]
        if settings.partial:
            weight = np.where(target.on_boundary(points), 0.0, weight)
            weight_back = np.where(source.boundary[back], 0.0, weight_back)
        if settings.reciprocal is not None:
            away = np.linalg.norm(target.mesh.vertices[target.usable] - points.positions[back], axis=1)
            weight_back = np.where(away > settings.reciprocal, 0.0, weight_back)
        return cls(points, near, back, weight, weight_back)

    def point_constraints(self, target: DeformableMesh) -> tuple[Floats, Floats]:
        """Weights (n,) and goals (n, 3) of the point constraints on vertices: to the target, and those from it."""
        place = target.mesh.vertices[target.usable]
        return weighted_goals(self.weight, self.points.positions, self.back, self.weight_back, place)


def _spectral_rows(source: DeformableMesh, views: tuple[View, View], images: Integers) -> tuple[Single, Single]:
    """Eigenfunctions (n, k), (q, k) of both surfaces as the map to `images` (n,) identifies them, weighted.

    In single precision. Column j holds target function j, and what is left of it when it is pulled back by the map and
    written in source functions.
    """
    k = min(view.functions.shape[1] for view in views)
    ours, theirs = (view.functions[:, :k].astype(np.float32) for view in views)
    weighted = theirs * np.float32(SPECTRAL_WEIGHT / np.sqrt(k))
    areas = source.areas.astype(np.float32)
    return ours @ (ours.T @ (areas[:, None] * weighted[images])), weighted
