"""Non-rigid registration: the source deformed in space until it lies on the target, bending where it must."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from geodesics import SurfacePoints
from geodesics.arrays import Floats
from gmds.registration.closest_points import ClosestPoints
from gmds.registration.deformable import DeformableMesh
from gmds.registration.residuals import Residuals
from gmds.surface.view import View

# stiffness, an area: the square of the distance over which misfits are averaged; and the number of steps
BEGIN: Sequence[tuple[float, int]] = ((3e-2, 6),)
COARSE: Sequence[tuple[float, int]] = ((1e-2, 4), (3e-3, 4))
FINE: Sequence[tuple[float, int]] = ((1e-3, 4), (5e-4, 4))
REFINE: Sequence[tuple[float, int]] = ((3e-3, 4), *FINE)  # of a map that is good already
SETTLE: Sequence[tuple[float, int]] = ((1e-3, 5), (5e-4, 4))
BACK: Sequence[tuple[float, int]] = ((3e-3, 4), (3e-3, 3), (1e-3, 3))
AGAIN: Sequence[tuple[float, int]] = ((1e-3, 3), (1e-3, 3), (5e-4, 3))
GIVEN_TIME = 1e-3  # heat time that smooths the given map before anything is fitted to it


@dataclass(frozen=True, eq=False)
class Registered:
    """A source on the target: its vertices are at y (n, 3), and closest to the `points` (n,) of the target.

    `strain` (n,): elastic energy around each vertex, per area.
    """

    y: Floats
    points: SurfacePoints
    strain: Floats
    residuals: Residuals


def register(
    source: DeformableMesh,
    target: DeformableMesh,
    images: Floats,
    stages: Sequence[tuple[float, int]] = (*BEGIN, *COARSE, *FINE),
    *,
    growing: bool,
    partial: bool = False,
    views: tuple[View, View] | None = None,
) -> Registered:
    """The source deformed so that its vertices, meant to go to `images` (n, 3), lie on the target.

    In the first stage vertices are pulled to the images given, against the elasticity; the others are as in `settled`.
    """
    elasticity, areas = source.elasticity, source.areas
    y = elasticity.smoother(GIVEN_TIME)(areas[:, None] * images)
    stiffness_weight, steps = stages[0]
    for _ in range(steps):
        pull = elasticity.right_hand_side(elasticity.local_similarities(y, growing))
        y = elasticity.smoother(stiffness_weight)(stiffness_weight * pull + areas[:, None] * images)
    return settled(source, target, y, stages[1:], growing=growing, partial=partial, views=views)


def settled(
    source: DeformableMesh,
    target: DeformableMesh,
    y: Floats,
    stages: Sequence[tuple[float, int]],
    *,
    growing: bool,
    partial: bool = False,
    views: tuple[View, View] | None = None,
) -> Registered:
    """The source, with its vertices at y (n, 3) to begin with, deformed so that they lie on the target.

    In turn, every vertex of either surface looks for the closest point of the other, in position and normal (as in
    ICP: Besl and McKay 1992; both ways, so that nothing of the target is left out), and the source takes the shape of
    least elastic energy that these point constraints
    allow. They grow ever stronger against the elasticity.
    `growing`: whether the elasticity lets parts change size; `partial`: whether what is closest to a boundary is left
    alone, as what it belongs to may be missing; `views` of both: whether eigenfunctions take part in the search. The
    anchors of the source pull as well.
    """
    elasticity = source.elasticity
    for stiffness_weight, steps in stages:
        closest = None
        for _ in range(steps):
            closest = ClosestPoints.of(source, target, y, partial, views, closest)
            weights, goals = closest.point_constraints(source, target)
            similarities = elasticity.local_similarities(y, growing)
            if source.anchors is not None:
                energy = float(elasticity.energy(y, similarities).sum())
                weights, goals = source.anchors.added_to((weights, goals), y, stiffness_weight, energy)
            pull = elasticity.right_hand_side(similarities)
            y = elasticity.solver(stiffness_weight, weights)(stiffness_weight * pull + weights[:, None] * goals)
    return registered(source, target, y, growing=growing, partial=partial)


def registered(
    source: DeformableMesh, target: DeformableMesh, y: Floats, *, growing: bool, partial: bool = False
) -> Registered:
    """The source with its vertices at y (n, 3), as it is."""
    elasticity, closest = source.elasticity, ClosestPoints.of(source, target, y, partial)
    points, back = closest.points, closest.back
    energy = elasticity.energy(y, elasticity.local_similarities(y, growing))
    gap = np.linalg.norm(points.positions - y, axis=1)
    gap_back = np.linalg.norm(target.mesh.vertices[target.usable] - y[back], axis=1)
    there = target.curvature[target.usable]
    residuals = Residuals(
        energy=float(energy.sum()),
        misfit=_root_mean_square(gap, closest.weight),
        misfit_back=_root_mean_square(gap_back, closest.weight_back),
        curvature=correlation(source.curvature, points.interpolate(target.curvature), closest.weight),
        curvature_back=correlation(there, source.curvature[back], closest.weight_back),
        landmarks=0.0 if source.anchors is None else source.anchors.neg_log_likelihood(y),
    )
    return Registered(y, points, energy / np.maximum(source.areas, np.finfo(float).tiny), residuals)


def both_ways(
    source: DeformableMesh, target: DeformableMesh, found: Registered, views: tuple[View, View] | None = None
) -> Registered:
    """A registration improved by the opposite one: the target deformed onto the source starts where this one ended.

    The source settles again from the middle between where it lay and where the deformed target says it belongs: what
    slides one way in the one slides the other way in the other. `views` as in `settled`.
    """
    begun = returning(source, target, found.y)
    opposite = None if views is None else (views[1], views[0])
    back = register(target, source, begun, BACK, growing=True, partial=True, views=opposite)
    rows = target.moved_features(back.y)
    near = target.usable[cKDTree(rows[target.usable]).query(source.features)[1]]
    there = target.closest(source.features, rows, near).positions
    return register(source, target, (found.y + there) / 2, AGAIN, growing=True, partial=True, views=views)


def returning(source: DeformableMesh, target: DeformableMesh, y: Floats) -> Floats:
    """Where the target's vertices go (q, 3) on a source that was deformed to y (n, 3): the way back."""
    features = source.moved_features(y)[source.usable]
    return source.mesh.vertices[source.usable[cKDTree(features).query(target.features)[1]]]


def _root_mean_square(values: Floats, weights: Floats) -> float:
    return float(np.sqrt(weights @ values**2 / max(weights.sum(), np.finfo(float).tiny)))


def correlation(x: Floats, y: Floats, weights: Floats) -> float:
    """Weighted correlation; 0 where one of them is constant, 1 where both are."""
    w = weights / max(weights.sum(), np.finfo(float).tiny)
    x, y = x - w @ x, y - w @ y
    square, other = w @ x**2, w @ y**2
    return float(w @ (x * y) / np.sqrt(square * other)) if square * other > 0 else float(square == other)
