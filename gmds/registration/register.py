"""Non-rigid registration: the source deformed in space until it lies on the target, bending where it must."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from geodesics import SurfacePoints
from geodesics.arrays import Floats
from geodesics.threads import both
from gmds.registration.closest_points import ClosestPoints
from gmds.registration.deformable import DeformableMesh
from gmds.registration.residuals import Residuals
from gmds.registration.settings import AFTER_RETURN, WAY_BACK, RegistrationSettings

LEAST_AREA = 1e-30  # of a vertex, below which it has none: a bound, so that energies per area stay numbers
GIVEN_TIME = 1e-3  # heat time, in units of the area, that smooths the given map before anything is fitted; set by hand


@dataclass(frozen=True, eq=False)
class Registered:
    """A source on the target.

    Attributes
    ----------
    y : float64 array of shape (n, 3)
        Where its vertices are.
    points : SurfacePoints
        The n points of the target they are closest to.
    strain : float64 array of shape (n,)
        Elastic energy around each vertex, per area.
    residuals : Residuals
        What is left.
    """

    y: Floats
    points: SurfacePoints
    strain: Floats
    residuals: Residuals


def register(
    source: DeformableMesh, target: DeformableMesh, images: Floats, settings: RegistrationSettings
) -> Registered:
    """The source deformed so that its vertices, meant to go to `images`, lie on the target.

    In the first stage vertices are pulled to the images given, against the elasticity; the others are as in `settled`.

    Parameters
    ----------
    source, target : DeformableMesh
        Surfaces of unit area.
    images : float64 array of shape (n, 3)
        Where a rough map sends the n vertices of the source.
    settings : RegistrationSettings
        In which stages, against which energy.

    Returns
    -------
    Registered
        The source where it ended.

    See Also
    --------
    settled : From where the source lies.
    """
    energy, areas = source.energy(settings.energy), source.areas
    y = source.laplacian.heat_step(GIVEN_TIME)(areas[:, None] * images)
    stiffness_weight, steps = settings.stages[0]
    for _ in range(steps):
        pull = energy.right_hand_side(energy.local_step(y))
        y = energy.system.implicit_step(stiffness_weight)(stiffness_weight * pull + areas[:, None] * images)
    return settled(source, target, y, settings.with_stages(settings.stages[1:]))


def settled(source: DeformableMesh, target: DeformableMesh, y: Floats, settings: RegistrationSettings) -> Registered:
    """The source, with its vertices at `y` to begin with, deformed so that they lie on the target.

    In turn, every vertex of either surface looks for the closest point of the other, in position and normal (as in ICP:
    Besl and McKay 1992; both ways, so that nothing of the target is left out), and the source takes the shape of least
    elastic energy that these point constraints allow. They grow ever stronger against the elasticity. The anchors of
    the source pull as well.

    Parameters
    ----------
    source, target : DeformableMesh
        Surfaces of unit area.
    y : float64 array of shape (n, 3)
        Where the vertices of the source are.
    settings : RegistrationSettings
        In which stages, against which energy.

    Returns
    -------
    Registered
        The source where it ended.

    See Also
    --------
    register : From a rough map.
    """
    energy = source.energy(settings.energy)
    closest = None
    for stiffness_weight, steps in settings.stages:
        closest = None if settings.restarts else closest
        for _ in range(steps):
            find = functools.partial(ClosestPoints.of, source, target, y, settings, closest)
            found, local = both(find, functools.partial(energy.local_step, y))
            closest, (weights, goals) = found, found.point_constraints(target)
            if source.anchors is not None:
                total = float(energy.value(y, local).sum())
                weights, goals = source.anchors.added_to((weights, goals), y, stiffness_weight, total)
            pull = energy.right_hand_side(local)
            y = energy.system.solver(stiffness_weight, weights)(stiffness_weight * pull + weights[:, None] * goals)
    return assessed(source, target, y, settings, closest)


def assessed(
    source: DeformableMesh,
    target: DeformableMesh,
    y: Floats,
    settings: RegistrationSettings,
    before: ClosestPoints | None = None,
) -> Registered:
    """The source with its vertices at y (n, 3), as it is: closest points by position and normal, and residuals.

    Where the points closest just `before` are known, they are looked for near those.
    """
    energy, settings = source.energy(settings.energy), replace(settings, views=None)
    closest = ClosestPoints.of(source, target, y, settings, before)
    points, back = closest.points, closest.back
    value = energy.value(y, energy.local_step(y))
    gap = np.linalg.norm(points.positions - y, axis=1)
    gap_back = np.linalg.norm(target.mesh.vertices[target.usable] - y[back], axis=1)
    there = target.curvature[target.usable]
    residuals = Residuals(
        energy=float(value.sum()),
        misfit=_root_mean_square(gap, closest.weight),
        misfit_back=_root_mean_square(gap_back, closest.weight_back),
        curvature=correlation(source.curvature, points.interpolate(target.curvature), closest.weight),
        curvature_back=correlation(there, source.curvature[back], closest.weight_back),
        landmarks=0.0 if source.anchors is None else source.anchors.neg_log_likelihood(y),
    )
    return Registered(y, points, value / np.maximum(source.areas, LEAST_AREA), residuals)


def both_ways(
    source: DeformableMesh, target: DeformableMesh, before: Registered, settings: RegistrationSettings
) -> Registered:
    """A registration improved by the opposite one: the target deformed onto the source starts where this one ended.

    The source settles again from the middle between where it lay and where the deformed target says it belongs: what
    slides one way in the one slides the other way in the other. The stages are `WAY_BACK` and `AFTER_RETURN`.
    """
    begun = returning(source, target, before.y)
    back = register(target, source, begun, settings.reversed.with_stages(WAY_BACK))
    rows = target.moved_features(back.y)
    near = target.usable[cKDTree(rows[target.usable]).query(source.features)[1]]
    there = target.closest(source.features, rows, near).positions
    return register(source, target, (before.y + there) / 2, settings.with_stages(AFTER_RETURN))


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
