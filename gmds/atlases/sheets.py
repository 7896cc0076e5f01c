"""The closest point of a surface that faces the same way: a hand on a thigh is not taken for it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from geodesics import Mesh, SurfacePoints, vertex_normals
from geodesics.arrays import Floats, Integers
from geodesics.closest import closest_on_triangles, closest_weights

# Root areas: how far away a point that faces the same way may be, and how much farther one that faces the other way
# counts as when some are looked for. Within this a point is where it belongs (`gmds.maps.confidence`).
REACH = 0.05
LOOKED_AT = 16  # faces, the nearest by middle and normal; set by hand


def closest_facing(
    places: Floats, normals: Floats | None, vertices: Floats, faces: Integers
) -> tuple[Integers, Floats]:
    """Of each place (p, 3) the face (p,) and the weights (p, 3) of the closest point on faces (m, 3) that face its way.

    `normals` (p, 3) are of the surface that the places are on; None asks for the closest alone. Where nothing near
    faces the same way the closest is taken. Which side is outside does not matter, if it is the same one everywhere.
    """
    face, weights, _ = closest_on_triangles(places, vertices, faces)
    if normals is None or not len(places):
        return face, weights
    corners = vertices[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(across, axis=1)
    size = np.sqrt(length.sum() / 2)
    across /= np.maximum(length, 1e-300)[:, None]
    agreement = (across[face] * normals).sum(axis=1)
    side = 1.0 if (agreement >= 0).mean() >= 0.5 else -1.0
    turned = np.flatnonzero(side * agreement < 0)
    if not len(turned):
        return face, weights
    tree = cKDTree(np.hstack([corners.mean(axis=1), REACH * size * across]))
    wanted = np.hstack([places[turned], side * REACH * size * normals[turned]])
    near = tree.query(wanted, k=min(LOOKED_AT, len(faces)))[1].reshape(len(turned), -1)
    found = closest_weights(np.repeat(places[turned], near.shape[1], axis=0), corners[near.ravel()])
    on = np.einsum("pk,pkj->pj", found, corners[near.ravel()]).reshape(*near.shape, 3)
    away = np.linalg.norm(on - places[turned][:, None], axis=2)
    away[side * (across[near] * normals[turned][:, None]).sum(axis=2) <= 0] = np.inf
    best = away.argmin(axis=1)
    rows = np.flatnonzero(away[np.arange(len(turned)), best] < REACH * size)
    face[turned[rows]] = near[rows, best[rows]]
    weights[turned[rows]] = found.reshape(*near.shape, 3)[rows, best[rows]]
    return face, weights


def located(points: ArrayLike | SurfacePoints, vertices: Floats, faces: Integers) -> tuple[Integers, Floats]:
    """Where places (p, 3), or points on a surface near by, whose normals then count, are on another."""
    if isinstance(points, SurfacePoints):
        return closest_facing(points.positions, points.interpolate(vertex_normals(points.mesh)), vertices, faces)
    on = SurfacePoints.closest(Mesh(vertices, faces), points)
    return on.face, on.barycentric
