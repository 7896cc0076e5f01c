"""Distances between points by the distance field of each of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics import Distance, SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.tracing import barycentric_gradient
from gmds._kernels import pair_distances as kernel

FIELDS = 2**23  # numbers of fields that are made together where they are not kept, 64 MB: a bound of memory


@dataclass(frozen=True, eq=False)
class FieldPairs:
    """All distances between p points by the distance field (p, n) of each of them, linear on faces.

    Both directions are averaged. Pairs that cannot reach each other are +inf.
    """

    points: SurfacePoints
    fields: Floats

    def distances(self) -> Floats:
        """Symmetric (p, p)."""
        first, second = np.triu_indices(len(self.points), 1)
        distances = np.zeros((len(self.points), len(self.points)))
        distances[first, second] = distances[second, first] = self.lengths(first, second)
        return distances

    def lengths(self, first: Integers, second: Integers) -> Floats:
        """Distances (r,) of chosen pairs."""
        return 0.5 * (
            lengths_in(self.fields, first, self.points, second) + lengths_in(self.fields, second, self.points, first)
        )

    def slopes(self, first: Integers, second: Integers, lengths: Floats, scale: Floats) -> Floats:
        """(r, 2, 2): the slope of the field of x_j at x_i, and of that of x_i at x_j, each times `scale` (r,)."""
        by_weights = barycentric_gradient(self.points)
        return kernel.field_slopes(first, second, self.fields, corners_of(self.points), by_weights, scale)


def lengths_in(fields: Floats, rows: Integers, points: SurfacePoints, index: Integers) -> Floats:
    """Chosen fields (p, n) at chosen points, (r,)."""
    return kernel.field_lengths(rows, index, fields, corners_of(points), points.barycentric)


def corners_of(points: SurfacePoints) -> Integers:
    """The vertices (p, 3) of the faces that points lie in."""
    return points.mesh.faces[points.face]


def lengths_of_fields(distance: Distance, points: SurfacePoints, first: Integers, second: Integers) -> Floats:
    """What `FieldPairs.lengths` is, (r,), of fields that are made from some points at a time and not kept."""
    lengths, at_once = np.zeros(len(first)), max(1, FIELDS // points.mesh.n_vertices)
    for start in range(0, len(points), at_once):
        field = np.ascontiguousarray(distance.field(points[start : start + at_once]), dtype=np.float64)
        for one, other in ((first, second), (second, first)):
            own = np.flatnonzero((one >= start) & (one < start + at_once))
            lengths[own] += 0.5 * lengths_in(field, one[own] - start, points, other[own])
    return lengths
