"""As affine as possible: what bends as little as the one affine map of the whole that is nearest."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from gmds.registration.energies.base import LocalGlobalEnergy, apply

FLAT = 1e-9  # share of the spread of a surface that its thinnest direction is given at the least: a bound


class NearlyAffine(LocalGlobalEnergy):
    r"""The Dirichlet energy of the displacement from the affine map of least energy.

    .. math:: E(y) = \min_B \sum_{ij} w_{ij} \, | y_i - y_j - B (x_i - x_j) |^2

    with one matrix :math:`B` for the whole surface. Nothing may turn by itself, so parts that move against each other
    cost much; a surface that is another one stretched and sheared, as teeth and brains of several species are, costs
    little, and it does not slide in itself to make up for that.

    See Also
    --------
    AsRigidAsPossible, AsSimilarAsPossible : Every neighbourhood turns by itself.
    """

    def sizes(self, sums: Floats) -> Floats:
        """1: sizes are those of B."""
        return np.ones(len(sums))

    def local_step(self, y: Floats) -> Floats:
        """B, the same at every vertex (n, 3, 3)."""
        x = self.laplacian.mesh.vertices
        lx = self.laplacian.matrix @ x
        spread = x.T @ lx
        spread += FLAT * np.trace(spread) * np.eye(3)
        matrix = np.linalg.solve(spread, lx.T @ y).T
        return np.broadcast_to(matrix, (len(x), 3, 3)).copy()

    def value(self, y: Floats, local: Floats) -> Floats:
        """The energy (n,) around each vertex."""
        return np.maximum(self.spread(y - apply(local, self.laplacian.mesh.vertices)), 0.0)
