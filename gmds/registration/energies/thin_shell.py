"""A thin shell: stretch as rigid as possible, and bending."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from geodesics.arrays import Floats
from geodesics.caching import cached_property
from gmds.registration.energies.base import LocalGlobalEnergy, apply
from gmds.registration.laplacian import CotangentLaplacian
from gmds.registration.stiffness import StiffnessSystem

BENDING = 1e-3  # an area, the square of a thickness: 3 % of the root of the area; set by hand, `match` does not use it


@dataclass(frozen=True, eq=False)
class ThinShell(LocalGlobalEnergy):
    r"""Stretch as rigid as possible, and the change of Laplacian coordinates; nothing changes size.

    .. math::
        E(y) = \min_R \sum_{ij} w_{ij} \, | y_i - y_j - R_i (x_i - x_j) |^2
            + b \sum_i A_i \, | \delta_i(y) - R_i \, \delta_i(x) |^2

    with :math:`\delta(y) = A^{-1} L y`, twice the mean curvature normal, which the rotations :math:`R_i` turn along.
    The stiffness matrix is :math:`L + \tfrac{b}{2} L A^{-1} L`, that of a linear thin shell.

    Parameters
    ----------
    laplacian : CotangentLaplacian
        Of the surface at rest.
    bending : float
        :math:`b`, an area: the square of a thickness.

    References
    ----------
    Botsch, Sorkine: On linear variational surface deformation methods (2008).

    See Also
    --------
    AsRigidAsPossible : Without bending.
    """

    laplacian: CotangentLaplacian
    bending: float = BENDING

    def sizes(self, sums: Floats) -> Floats:
        """1."""
        return np.ones(len(sums))

    @cached_property
    def system(self) -> StiffnessSystem:
        """L + b/2 L A^-1 L."""
        laplacian = self.laplacian.matrix
        bent = laplacian @ sp.diags(0.5 * self.bending * self._per_area) @ laplacian
        return StiffnessSystem(sp.csr_matrix(laplacian + bent), self.laplacian.areas)

    def right_hand_side(self, local: Floats) -> Floats:
        """What K y has to be (n, 3) for the vertices that go best with the rotations (n, 3, 3)."""
        turned = apply(local, self._per_area[:, None] * self._rest)
        return super().right_hand_side(local) + 0.5 * self.bending * (self.laplacian.matrix @ turned)

    def products(self, y: Floats) -> Floats:
        """sum_j w_ij (x_i - x_j)(y_i - y_j)^T + b A_i d_i(x) d_i(y)^T, (n, 3, 3)."""
        weighted = (self.bending * self._per_area)[:, None] * self._rest
        return super().products(y) + weighted[:, :, None] * (self.laplacian.matrix @ y)[:, None, :]

    def spread(self, y: Floats) -> Floats:
        """sum_j w_ij |y_i - y_j|^2 + b A_i |d_i(y)|^2, (n,)."""
        square = ((self.laplacian.matrix @ y) ** 2).sum(axis=1)
        return super().spread(y) + self.bending * self._per_area * square

    @cached_property
    def _rest(self) -> Floats:
        """L x (n, 3)."""
        return np.asarray(self.laplacian.matrix @ self.laplacian.mesh.vertices, dtype=np.float64)

    @property
    def _per_area(self) -> Floats:
        """One over the area (n,) of each vertex; 0 where there is none."""
        areas = self.laplacian.areas
        return np.divide(1.0, areas, out=np.zeros_like(areas), where=areas > 0)
