"""Distances between points of one surface, and how they change when the points move: in coordinates, or by fields."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, cast

import numpy as np

from geodesics import Distance, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import cached_property
from geodesics.memory import must_fit
from geodesics.topology.components import vertex_components
from geodesics.tracing import gradient
from gmds._kernels import pair_distances as kernel
from gmds.mds.field_pairs import FIELDS, FieldPairs, lengths_of_fields

TABULATE = "make it a `gmds.TabulatedDistance`, which holds some hundred numbers a vertex, or ask for fewer samples"
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
class Reach:
    """Which points can reach each other: the component (p,) of each, and the points (c, p) that each reaches."""

    component: Integers
    finite: Bools

    def __call__(self, first: Integers, second: Integers) -> Bools:
        """Whether chosen pairs can."""
        return np.asarray(self.finite[self.component[first], second])


@dataclass(frozen=True, eq=False)
class EmbeddedPairs:
    """All distances between p points of an embedding, exact also inside the faces, as in (3.1) and (3.2)."""

    points: SurfacePoints
    embedding: Floats
    signature: Floats
    reach: Reach | None = None

    def distances(self) -> Floats:
        """Symmetric (p, p); +inf out of `reach`."""
        e = self.rows
        gram = (e * self.signature) @ e.T
        norm = np.diagonal(gram)
        square = norm[:, None] + norm[None] - (gram + gram.T)
        np.fill_diagonal(square, 0.0)
        distances = np.sqrt(np.maximum(square, 0.0))
        every = np.arange(len(e))
        return distances if self.reach is None else np.where(self.reach(every[:, None], every), distances, np.inf)

    def lengths(self, first: Integers, second: Integers) -> Floats:
        """Distances (r,) of chosen pairs."""
        if self._few(first):
            lengths = kernel.lengths(first, second, self.rows, self.signature)
        else:
            lengths = kernel.lengths_of_products(first, second, (self.rows * self.signature) @ self.rows.T)
        return lengths if self.reach is None else np.where(self.reach(first, second), lengths, np.inf)

    def slopes(self, first: Integers, second: Integers, lengths: Floats, scale: Floats) -> Floats:
        """(r, 2, 2): (e_i - e_j) . grad e_i / d, and the same of j, each times `scale` (r,); 0 where d = 0."""
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


class Pairs(Protocol):
    """Distances between p points of a surface."""

    def lengths(self, first: Integers, second: Integers) -> Floats:
        """Distances (r,) of chosen pairs, +inf where a point cannot reach another."""

    def slopes(self, first: Integers, second: Integers, lengths: Floats, scale: Floats) -> Floats:
        """(r, 2, 2): the derivative of each distance by the in-face displacement of its two points, times `scale`."""


def pairwise(distance: Distance, points: SurfacePoints) -> EmbeddedPairs | FieldPairs:
    """Distances between the points, in the embedding of the distance if it has one, else by fields.

    Raises `WouldExceedMemory` (E501) when the fields do not fit.
    """
    if not hasattr(distance, "embedding"):
        must_fit(len(points) * points.mesh.n_vertices, "distance fields of all samples", TABULATE)
        return FieldPairs(points, np.ascontiguousarray(distance.field(points), dtype=np.float64))
    embedding = cast(EmbeddedDistance, distance).embedding
    signature = getattr(distance, "signature", np.ones(embedding.shape[1]))
    return EmbeddedPairs(points, embedding, signature, _reach(distance, points))


def lengths_between(distance: Distance, points: SurfacePoints, first: Integers, second: Integers) -> Floats:
    """Distances (r,) of chosen pairs of points, as `pairwise` measures them; no field is kept."""
    if hasattr(distance, "embedding"):
        return pairwise(distance, points).lengths(first, second)
    return lengths_of_fields(distance, points, first, second)


def distances_to(distance: Distance, points: SurfacePoints, vertices: Integers) -> Floats:
    """Distances (p, g) from points to some vertices: in coordinates, or by fields of which the rest is not kept."""
    if not hasattr(distance, "embedding"):
        at_once = max(1, FIELDS // points.mesh.n_vertices)
        parts = [points[start : start + at_once] for start in range(0, len(points), at_once)]
        return np.concatenate([distance.field(part)[:, vertices] for part in parts])
    embedding = cast(EmbeddedDistance, distance).embedding
    signature = getattr(distance, "signature", np.ones(embedding.shape[1]))
    here, there = points.interpolate(embedding), embedding[vertices]
    lengths = (here**2 @ signature)[:, None] + there**2 @ signature - 2 * (here * signature) @ there.T
    np.sqrt(np.maximum(lengths, 0.0, out=lengths), out=lengths)
    label = vertex_components(points.mesh)
    lengths[label[points.mesh.faces[points.face, 0]][:, None] != label[vertices]] = np.inf
    return lengths


def _reach(distance: Distance, points: SurfacePoints) -> Reach | None:
    """Which points can reach each other, asked once per component of the mesh; None: all of them."""
    label = vertex_components(points.mesh)[points.mesh.faces[points.face, 0]]
    present, first, component = np.unique(label, return_index=True, return_inverse=True)
    if len(present) == 1:
        return None
    finite = np.isfinite(distance.field(points[first])[:, points.mesh.faces[points.face, 0]])
    return Reach(component.reshape(-1), finite)
