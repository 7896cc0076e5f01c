"""A map as smooth as its surface bears: splines of positions on the source, brought back to the target."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from geodesics import SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.caching import cached_property
from gmds.registration.deformable import DeformableMesh
from gmds.registration.stiffness import StiffnessSystem

# Squared areas: what varies as eigenfunctions do beyond the one of eigenvalue 1 / sqrt(STIFFNESS) = 1000, about the
# 80th, is smoothed away. 3e-7 and 3e-6 are as good on development pairs (benchmarks/results/notes.md, "Plain GMDS").
STIFFNESS = 1e-6
BETWEEN = 0.1  # weight of the map between samples, as a share of theirs: a tenth, as in `Refiner.continued`
LEAST_AREA = 1e-3  # of the mean, that a vertex counts as: a bound


@dataclass(frozen=True, eq=False)
class ThinPlate:
    r"""Thin-plate splines of positions on one surface,

    .. math:: \min_y \; \sum_i w_i \, |y_i - g_i|^2 + \sigma \int |\Delta y|^2 \, da

    with goals g and weights w of sum one. What comes out lies near a target, and is `projected` there.

    Attributes
    ----------
    source, target : DeformableMesh
        Of unit area.

    References
    ----------
    Duchon: Splines minimizing rotation-invariant semi-norms in Sobolev spaces (1977); on meshes with the squared
    cotangent Laplacian.
    """

    source: DeformableMesh
    target: DeformableMesh

    @cached_property
    def _bending(self) -> StiffnessSystem:
        laplacian, areas = self.source.laplacian.matrix, self.source.areas
        inverse = sp.diags(1 / np.maximum(areas, LEAST_AREA / len(areas)))
        return StiffnessSystem(sp.csr_matrix(laplacian @ inverse @ laplacian), areas)

    def smoothed(self, points: SurfacePoints) -> SurfacePoints:
        """The map to `points` (n,) of the target made smooth."""
        areas = self.source.areas
        return self.projected(self._bending.solver(STIFFNESS, areas)(areas[:, None] * points.positions))

    def through(self, samples: Integers, placed: SurfacePoints, points: SurfacePoints) -> SurfacePoints:
        """A smooth map that brings samples (p,) near the p points they are `placed` at, and the rest near `points`."""
        n, share = len(self.source.areas), np.full(len(samples), 1 / len(samples))
        at, between = np.bincount(samples, share, n), BETWEEN * self.source.areas
        pull = between[:, None] * points.positions
        np.add.at(pull, samples, share[:, None] * placed.positions)
        return self.projected(self._bending.solver(STIFFNESS, at + between)(pull))

    def projected(self, y: Floats) -> SurfacePoints:
        """The points of the target closest to the source with its vertices at y (n, 3), in position and normal."""
        features = self.source.moved_features(y)
        near = self.target.usable[self.target.tree.query(features)[1]]
        return self.target.closest(features, self.target.features, near)
