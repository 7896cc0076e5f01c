"""Distances between points of one surface, and how they change when the points move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, cast

import numpy as np

from geodesics import Distance, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import cached_property
from geodesics.topology.components import vertex_components
from geodesics.tracing import barycentric_gradient, gradient
from gmds._kernels import pair_distances as kernel

SPARSE = 4
"""Pairs are measured one by one where they are fewer than one in `SPARSE` of p x p; else a product of matrices is
quicker (`benchmarks/cost/solver_cost.py`)."""


class EmbeddedDistance(Distance, Protocol):
    """A distance that is Euclidean in an embedding linear on faces: d(x, y) = |e(x) - e(y)|, e (n, k) at the vertices.

    A `signature` (k,) of +1 and -1, if there is one, makes it pseudo-Euclidean: |v|^2 = sum of signature * v^2.
    """

    @property
    def embedding(self) -> Floats:
        """e at the vertices, (n, k)."""


@dataclass(frozen=True, eq=False)
class EmbeddedPairs:
    """All distances between p points of an embedding, exact also inside the faces, as in (3.1) and (3.2)."""

    points: SurfacePoints
    embedding: Floats
    signature: Floats
    reach: Bools | None = None

    def distances(self) -> Floats:
        """Symmetric (p, p); +inf where `reach` (p, p) is False."""
        e = self.rows
        gram = (e * self.signature) @ e.T
        norm = np.diagonal(gram)
        square = norm[:, None] + norm[None] - (gram + gram.T)
        np.fill_diagonal(square, 0.0)
        distances = np.sqrt(np.maximum(square, 0.0))
        return distances if self.reach is None else np.where(self.reach, distances, np.inf)

    def derivatives(self, distances: Floats) -> Floats:
        """(p, 2, p): of d(x_i, x_j) by the in-face displacement of x_i, = (e_i - e_j) . grad e_i / d; 0 where d = 0."""
        product, index = self._products, np.arange(len(self.points))
        with np.errstate(divide="ignore"):
            inverse = np.where(distances > 0, 1 / distances, 0.0)
        return (product[index, :, index][:, :, None] - product) * inverse[:, None, :]

    def lengths(self, first: Integers, second: Integers) -> Floats:
        """Distances (r,) of chosen pairs."""
        if self._few(first):
            lengths = kernel.lengths(first, second, self.rows, self.signature)
        else:
            lengths = kernel.lengths_of_products(first, second, (self.rows * self.signature) @ self.rows.T)
        return lengths if self.reach is None else np.where(self.reach[first, second], lengths, np.inf)

    def slopes(self, first: Integers, second: Integers, lengths: Floats, scale: Floats) -> Floats:
        """(r, 2, 2): what `derivatives` says of chosen pairs, first of their first point, each times `scale` (r,)."""
        if self._few(first):
            return kernel.slopes(first, second, self.rows, self.signature, self._gradients, lengths, scale)
        return kernel.slopes_of_products(first, second, self._products, lengths, scale)

    @cached_property
    def rows(self) -> Floats:
        """The points in the embedding, (p, k)."""
        return self.points.interpolate(self.embedding)

    @property
    def _gradients(self) -> Floats:
        """Of the embedding at the points, (p, 2, k)."""
        return np.ascontiguousarray(gradient(self.points, self.embedding).transpose(0, 2, 1))

    @property
    def _products(self) -> Floats:
        """Gradients at x_i times the rows of all x_j, (p, 2, p)."""
        e, slope = self.rows * self.signature, gradient(self.points, self.embedding).transpose(0, 2, 1)
        return (slope.reshape(-1, slope.shape[2]) @ e.T).reshape(len(e), 2, len(e))

    def _few(self, first: Integers) -> bool:
        return SPARSE * len(first) < len(self.points) ** 2


@dataclass(frozen=True, eq=False)
class FieldPairs:
    """All distances between p points by the distance field (p, n) of each of them, linear on faces.

    Both directions are averaged. Pairs that cannot reach each other are +inf.
    """

    points: SurfacePoints
    fields: Floats

    def distances(self) -> Floats:
        """Symmetric (p, p)."""
        corners = self.fields[:, self.points.mesh.faces[self.points.face]]
        with np.errstate(invalid="ignore"):  # 0 * inf at a corner without weight
            there = np.nansum(corners * self.points.barycentric, axis=2)
        distances = 0.5 * (there + there.T)
        np.fill_diagonal(distances, 0.0)
        return distances

    def derivatives(self, distances: Floats) -> Floats:
        """(p, 2, p): of d(x_i, x_j) by the in-face displacement of x_i, = the slope of the field of x_j at x_i."""
        corners = self.fields[:, self.points.mesh.faces[self.points.face]]
        corners = np.where(np.isfinite(corners).all(axis=2, keepdims=True), corners, 0.0)
        return np.einsum("qpk,pkx->pxq", corners, barycentric_gradient(self.points))


class Pairs(Protocol):
    """All distances between p points of a surface."""

    def distances(self) -> Floats:
        """Symmetric (p, p), +inf where a point cannot reach another."""

    def derivatives(self, distances: Floats) -> Floats:
        """(p, 2, p): entry [i, :, j] is the derivative of d(x_i, x_j) by the in-face displacement of x_i."""


def pairwise(distance: Distance, points: SurfacePoints) -> Pairs:
    """Distances between the points: as the distance itself says, in its embedding if it has one, else by fields."""
    if hasattr(distance, "pairs"):
        return cast(Pairs, distance.pairs(points))
    if hasattr(distance, "embedding"):
        embedding = cast(EmbeddedDistance, distance).embedding
        signature = getattr(distance, "signature", np.ones(embedding.shape[1]))
        return EmbeddedPairs(points, embedding, signature, _reach(distance, points))
    return FieldPairs(points, distance.field(points))


def _reach(distance: Distance, points: SurfacePoints) -> Bools | None:
    """Which points can reach each other (p, p), asked once per component of the mesh; None: all of them."""
    label = vertex_components(points.mesh)[points.mesh.faces[points.face, 0]]
    present, first, component = np.unique(label, return_index=True, return_inverse=True)
    if len(present) == 1:
        return None
    finite = np.isfinite(distance.field(points[first])[:, points.mesh.faces[points.face, 0]])
    return finite[component.reshape(-1)]
