"""Landmarks in a registration: springs that hold points of a deformed surface where they belong, or pull them there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics.arrays import Floats, Integers

HARD = 1e3  # springs of hard landmarks against the elasticity: they are missed by a thousandth of what they move
HIT = 0.02  # root areas within which a hard landmark counts as hit when maps are compared


@dataclass(frozen=True, eq=False)
class Anchors:
    """Points of a surface, vertices `corners` (k, 3) with `weights` (k, 3), that belong at `ends` (k, 3).

    `tolerance` (k,): root areas to within which that is known; 0: exactly. What is known has the density
    1 / sqrt(1 + (d / tolerance)^2) of the distance d it is missed by (Cauchy): a landmark that is wrong by much is
    given up rather than believed.
    """

    corners: Integers
    weights: Floats
    ends: Floats
    tolerance: Floats

    def positions(self, y: Floats) -> Floats:
        """Where the points are (k, 3) when the vertices are at y (n, 3)."""
        return np.asarray(np.einsum("kc,kcj->kj", self.weights, y[self.corners]), dtype=np.float64)

    def loss(self, y: Floats) -> float:
        """Minus the log-likelihood up to a constant: the sum of log sqrt(1 + (d / tolerance)^2)."""
        missed = np.linalg.norm(self.positions(y) - self.ends, axis=1)
        scale = np.where(self.tolerance > 0, self.tolerance, HIT)
        return float(np.log1p((missed / scale) ** 2).sum() / 2)

    def added(self, springs: tuple[Floats, Floats], y: Floats, stiff: float, energy: float) -> tuple[Floats, Floats]:
        """Weights (n,) and ends (n, 3) of springs, with those of the landmarks added, for vertices at y.

        With E the elastic energy, minus the log-likelihood log sqrt(E) + log sqrt(1 + (d / t)^2) falls as fast as the
        energy of a spring of weight E / (2 (t^2 + d^2)) beside the elasticity does (t the tolerance).
        """
        weights, ends = springs
        offset = self.ends - self.positions(y)
        square = self.tolerance**2 + (offset**2).sum(axis=1)
        soft = energy / (2 * np.maximum(square, np.finfo(float).tiny))
        strength = stiff * np.where(self.tolerance > 0, np.minimum(soft, HARD), HARD)
        at, share = self.corners.ravel(), (strength[:, None] * self.weights).ravel()
        goals = (y[self.corners] + offset[:, None, :]).reshape(-1, 3)  # a spring moves the whole triangle
        total, moved = weights.copy(), weights[:, None] * ends
        np.add.at(total, at, share)
        np.add.at(moved, at, share[:, None] * goals)
        return total, moved / np.maximum(total, np.finfo(float).tiny)[:, None]
