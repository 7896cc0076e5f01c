"""From placed samples to every vertex, anywhere on the triangles."""

from __future__ import annotations

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Floats, Integers
from gmds._kernels.closest import closest_on_faces
from gmds.spectral.functional_maps import functional_map, nearest_rows
from gmds.surface.view import View

# Samples that each eigenfunction needs, and eigenfunctions that are used all the same if there are as many samples: a
# fit to fewer oscillates between them. Set by hand.
PER_FUNCTION = 3
FEWEST = 8
ROUNDS = 8  # from vertex to vertex for the closest point, at the most: a bound


def extend(source: View, target: View, samples: Integers, placed: SurfacePoints, count: int) -> SurfacePoints:
    """The points of the target, one for each source vertex, that continue samples (p,) placed at p points.

    A functional map of at most `count` eigenfunctions, and at most one for every three samples, is fitted to the placed
    samples; each vertex then goes to the closest point of the target's surface in the space of eigenfunctions, inside a
    triangle if need be. In commute-time coordinates this is trilateration: the point whose distances to the placed
    samples are right.
    """
    p = len(np.unique(samples))
    k = min(count, max(p // PER_FUNCTION, min(p, FEWEST)), source.functions.shape[1], target.functions.shape[1])
    ours, theirs = source.functions[:, :k], target.functions[:, :k]
    matrix = functional_map(ours[samples], placed.interpolate(theirs))
    return closest_points(target, theirs @ matrix.T, ours)


def closest_points(target: View, rows: Floats, queries: Floats) -> SurfacePoints:
    """Points of the target's surface, embedded by `rows` (n, k) linear on faces, closest to `queries` (p, k)."""
    usable = target.usable
    guess = usable[nearest_rows(queries, rows[usable], np.float64)]
    faces = target.mesh.faces
    ring = np.argsort(faces.ravel(), kind="stable") // 3
    start = np.concatenate([[0], np.cumsum(np.bincount(faces.ravel(), minlength=target.mesh.n_vertices))])
    face, weight, _ = closest_on_faces(
        np.ascontiguousarray(queries), np.ascontiguousarray(rows), faces, ring, start, guess, ROUNDS
    )
    return SurfacePoints(target.mesh, face, weight)
