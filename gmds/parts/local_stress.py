"""Generalised multidimensional scaling at all vertices of simplified meshes, by distances that a cut leaves alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics import GeodesicDistance, SurfacePoints, embedded
from geodesics.arrays import Floats, Integers
from geodesics.caching import memoized
from gmds.parts.extremities import finite
from gmds.registration.deformable import DeformableMesh

ANCHORS = 120  # farthest points whose images are believed in turn
REACH = 0.35  # root areas of the whole over which distances lose weight: short ones do not know what is missing
REPEATS = 2  # placements from one set of images


@dataclass(frozen=True, eq=False)
class LocalStress:
    """The weighted stress of a map between the vertices of a simplified source and those of a simplified target.

    Vertex x is placed at the y of least sum_a w_a(x) (s d_S(x, a) - d_Q(y, rho a))^2 over anchors a with images rho a,
    s the size of the source on the target, w_a(x) = q_a exp(-s d_S(x, a) / `REACH`), q_a how far the image of a is
    believed: the truncated, partial form of the stress of sec. 5.
    """

    source: DeformableMesh
    target: DeformableMesh

    def placed(self, images: Integers, belief: Floats, size: float) -> Integers:
        """Where all source vertices go (n,), for images (n,) that are believed by `belief` (n,)."""
        ours, theirs, anchors = mutual_distances(self.source), mutual_distances(self.target), farthest(self.source)
        here = size * ours[:, anchors]
        weights = belief[anchors] * np.exp(-here / REACH)
        weights /= np.maximum(weights.sum(axis=1, keepdims=True), np.finfo(float).tiny)
        for _ in range(REPEATS):
            there = theirs[:, images[anchors]]
            stress = weights @ (there**2).T - 2 * (weights * here) @ there.T  # but for what does not depend on y
            images = self.target.usable[stress[:, self.target.usable].argmin(axis=1)]
        return images


@memoized
def mutual_distances(surface: DeformableMesh) -> Floats:
    """Geodesic distances between all vertices (n, n) of a simplified mesh; 0 from vertices on no face."""
    mesh, distances = surface.mesh, np.zeros((surface.mesh.n_vertices,) * 2)
    distances[surface.usable] = finite(
        GeodesicDistance(embedded(mesh)).field(SurfacePoints.at_vertices(mesh, surface.usable))
    )
    return distances


@memoized
def farthest(surface: DeformableMesh) -> Integers:
    """Farthest points (`ANCHORS`,) of a simplified mesh."""
    distances, usable = mutual_distances(surface), surface.usable
    chosen = [int(usable[0])]
    nearest = distances[chosen[0]].copy()
    for _ in range(min(ANCHORS, len(usable)) - 1):
        chosen.append(int(usable[nearest[usable].argmax()]))
        nearest = np.minimum(nearest, distances[chosen[-1]])
    return np.array(chosen, dtype=np.int64)
