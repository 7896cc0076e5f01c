"""What a deformation energy is, and what those share that compare edges with turned ones."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from geodesics.arrays import Floats
from geodesics.caching import cached_property
from gmds._kernels.deformation import products, spread, turned_differences
from gmds._kernels.rotations import nearest_rotations
from gmds.registration.laplacian import CotangentLaplacian
from gmds.registration.stiffness import StiffnessSystem


class Energy(Protocol):
    r"""What it costs to move the vertices x of a surface to y: quadratic once a local step is done.

    With `local` held, the gradient of the total is :math:`4 (K y - \mathrm{rhs})`, K the matrix of `system` and rhs
    what `right_hand_side(local)` gives.

    See Also
    --------
    AsRigidAsPossible, AsSimilarAsPossible, ThinShell : Those there are.
    """

    @property
    def system(self) -> StiffnessSystem:
        """The stiffness matrix K (n, n), and the systems made of it."""

    def local_step(self, y: Floats) -> Floats:
        """The local unknowns of least energy, a matrix (n, 3, 3) a vertex, for vertices at y (n, 3)."""

    def right_hand_side(self, local: Floats) -> Floats:
        """What K y has to be (n, 3) for the vertices that go best with the local unknowns."""

    def value(self, y: Floats, local: Floats) -> Floats:
        """The energy (n,) around each vertex."""


EnergyKind = Callable[[CotangentLaplacian], Energy]


@dataclass(frozen=True, eq=False)
class LocalGlobalEnergy(ABC):
    r"""An energy that compares edges with rotated and resized ones, as subclasses allow.

    .. math:: E(y) = \min_{R, s} \sum_{ij} w_{ij} \, | y_i - y_j - s_i R_i (x_i - x_j) |^2

    with rotations :math:`R_i`, the sizes :math:`s_i` that subclasses choose, and cotangent weights :math:`w_{ij}`, so
    that flat stretch costs its Dirichlet energy. The local step finds the similarities :math:`s_i R_i`, the global step
    the vertices.

    Parameters
    ----------
    laplacian : CotangentLaplacian
        Of the surface at rest.

    References
    ----------
    Sorkine, Alexa: As-rigid-as-possible surface modeling (2007).
    """

    laplacian: CotangentLaplacian

    @abstractmethod
    def sizes(self, sums: Floats) -> Floats:
        """s_i (n,), where `sums` (n,) are tr(R_i^T sum_j w_ij (x_i - x_j)(y_i - y_j)^T) of the best rotations."""

    @property
    def system(self) -> StiffnessSystem:
        """The Laplacian."""
        return self.laplacian.system

    def local_step(self, y: Floats) -> Floats:
        """The similarities s_i R_i (n, 3, 3) that go best with vertices at y (n, 3)."""
        rotations, sums = nearest_rotations(self.products(y))
        return np.asarray(rotations * self.sizes(sums)[:, None, None], dtype=np.float64)

    def right_hand_side(self, local: Floats) -> Floats:
        """What L y has to be (n, 3) for the vertices that go best with the matrices (n, 3, 3)."""
        return turned_differences(*self.laplacian.edges, self.laplacian.mesh.vertices, local)

    def value(self, y: Floats, local: Floats) -> Floats:
        """The energy (n,) around each vertex."""
        squares = np.einsum("nab,nab->n", local, local) / 3
        mixed = np.einsum("nba,nab->n", local, self.products(y))
        return np.maximum(self.spread(y) - 2 * mixed + squares * self.rest_spread, 0.0)

    @cached_property
    def rest_spread(self) -> Floats:
        """sum_j w_ij |x_i - x_j|^2 (n,)."""
        return self.spread(self.laplacian.mesh.vertices)

    def products(self, y: Floats) -> Floats:
        """sum_j w_ij (x_i - x_j)(y_i - y_j)^T, (n, 3, 3)."""
        return products(*self.laplacian.edges, self.laplacian.mesh.vertices, y)

    def spread(self, y: Floats) -> Floats:
        """sum_j w_ij |y_i - y_j|^2 (n,)."""
        return spread(*self.laplacian.edges, y)


def apply(matrices: Floats, rows: Floats) -> Floats:
    """Each matrix (n, 3, 3) times its row (n, 3)."""
    return np.asarray(np.einsum("nab,nb->na", matrices, rows), dtype=np.float64)
