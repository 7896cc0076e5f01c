"""Landmarks in a registration: points of a deformed surface that are held, or pulled to, where they belong."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.barycentric import combination

# Weight of hard landmarks against the elasticity: they are missed by a thousandth of what they move. A tenth and a
# hundredth of it were worse on development pairs of SHREC'20 (benchmarks/results/notes.md, "Landmarks").
HARD = 1e3
HIT = 0.02  # root areas within which a hard landmark counts as met when maps are compared; set by hand


@dataclass(frozen=True, eq=False)
class Anchors:
    """Points of a surface, vertices `corners` (k, 3) with `weights` (k, 3), that belong at `ends` (k, 3).

    `tolerance` (k,): root areas to within which that holds; 0: exactly. A landmark has the density
    1 / sqrt(1 + (d / tolerance)^2) of the distance d it is missed by (Cauchy): a landmark that is wrong by much is
    given up rather than believed.
    """

    corners: Integers
    weights: Floats
    ends: Floats
    tolerance: Floats

    def positions(self, y: Floats) -> Floats:
        """Where the points are (k, 3) when the vertices are at y (n, 3)."""
        return combination(self.weights, y[self.corners])

    @property
    def nearest_vertices(self) -> Integers:
        """The heaviest corners (k,)."""
        return self.corners[np.arange(len(self.corners)), self.weights.argmax(axis=1)]

    def missed(self, y: Floats) -> Floats:
        """The distances (k,) of the points from where they belong when the vertices are at y (n, 3)."""
        return np.asarray(np.linalg.norm(self.positions(y) - self.ends, axis=1), dtype=np.float64)

    def neg_log_likelihood(self, y: Floats) -> float:
        """Minus the log-likelihood up to a constant: the sum of log sqrt(1 + (d / tolerance)^2)."""
        missed = self.missed(y)
        scale = np.where(self.tolerance > 0, self.tolerance, HIT)
        return float(np.log1p((missed / scale) ** 2).sum() / 2)

    def added_to(
        self, point_constraints: tuple[Floats, Floats], y: Floats, stiffness_weight: float, energy: float
    ) -> tuple[Floats, Floats]:
        """Point constraints, weights (n,) and goals (n, 3), with those of the landmarks added, for vertices at y.

        With E the elastic energy, minus the log-likelihood log sqrt(E) + log sqrt(1 + (d / t)^2) falls as fast as the
        energy of a point constraint of weight E / (2 (t^2 + d^2)) beside the elasticity does (t the tolerance).
        """
        weights, goals = point_constraints
        offset = self.ends - self.positions(y)
        square = self.tolerance**2 + (offset**2).sum(axis=1)
        soft = energy / (2 * np.maximum(square, np.finfo(float).tiny))
        strength = stiffness_weight * np.where(self.tolerance > 0, np.minimum(soft, HARD), HARD)
        at, share = self.corners.ravel(), (strength[:, None] * self.weights).ravel()
        moved = (y[self.corners] + offset[:, None, :]).reshape(-1, 3)  # a landmark moves its whole triangle
        total, sums = weights.copy(), weights[:, None] * goals
        np.add.at(total, at, share)
        np.add.at(sums, at, share[:, None] * moved)
        return total, sums / np.maximum(total, np.finfo(float).tiny)[:, None]
