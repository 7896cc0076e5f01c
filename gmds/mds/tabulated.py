"""A distance written down once, from a few hundred fields, so that any pair of points is a short sum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics import Distance, Mesh, SurfacePoints, farthest_point_sampling
from geodesics.arrays import Floats, Integers
from geodesics.topology.components import vertex_components


@dataclass(frozen=True, eq=False, init=False)
class TabulatedDistance:
    """A distance as a pseudo-Euclidean embedding e (n, k), from its fields at `landmarks` farthest points.

    d(x, y)^2 = sum of signature * (e(x) - e(y))^2, signature (k,) of +1 and -1: classical scaling of the squared
    distances between the landmarks, extended to all vertices (Shamai and Kimmel, "Geodesic distance descriptors",
    2017), cut to the `rank` largest eigenvalues in size. Geodesic distances come out within about a thousandth of
    their mean. Never n x n: landmarks x n numbers are held while it is made, rank x n afterwards.
    """

    distance: Distance
    embedding: Floats
    signature: Floats

    def __init__(self, distance: Distance, landmarks: int = 300, rank: int = 120) -> None:
        if landmarks < 2 or rank < 1:
            raise ValueError(f"a table needs 2 landmarks and rank 1 at least, not {landmarks} and {rank}")
        mesh = distance.mesh
        label = vertex_components(mesh)
        chosen = farthest_point_sampling(distance, min(landmarks, int((label >= 0).sum())))
        fields = distance.field(SurfacePoints.at_vertices(mesh, chosen))
        blocks = [_scaled_component(fields, chosen, label, c, rank) for c in range(label.max() + 1)]
        object.__setattr__(self, "distance", distance)
        object.__setattr__(self, "embedding", np.concatenate([block for block, _ in blocks], axis=1))
        object.__setattr__(self, "signature", np.concatenate([sign for _, sign in blocks]))

    @property
    def mesh(self) -> Mesh:
        """The mesh whose vertices distances are given at."""
        return self.distance.mesh

    def field(self, points: SurfacePoints) -> Floats:
        """Distances (p, n) from each of p points to every vertex, by the distance itself."""
        return self.distance.field(points)


def _scaled_component(
    fields: Floats, chosen: Integers, label: Integers, component: int, rank: int
) -> tuple[Floats, Floats]:
    """Embedding (n, k) of one component, zero elsewhere, and its signature (k,)."""
    own, there = np.flatnonzero(label[chosen] == component), label == component
    square = fields[np.ix_(own, np.flatnonzero(there))] ** 2
    between = fields[np.ix_(own, chosen[own])] ** 2
    between = 0.5 * (between + between.T)
    centred = -0.5 * _centred(_centred(between).T)
    values, vectors = np.linalg.eigh(centred)
    order = np.argsort(-np.abs(values), kind="stable")[: max(1, min(rank, len(own) // 2))]
    order = order[np.abs(values[order]) > 1e-9 * np.abs(values).max()]
    values, vectors = values[order], vectors[:, order]
    extended = -0.5 * _centred(square - between.mean(axis=1, keepdims=True))
    embedding = np.zeros((len(label), len(order)))
    embedding[there] = extended.T @ (vectors * (np.sign(values) / np.sqrt(np.abs(values))))
    return embedding, np.sign(values)


def _centred(rows: Floats) -> Floats:
    """Each column minus its mean."""
    return rows - rows.mean(axis=0)
