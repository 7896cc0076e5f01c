"""The cotangent Laplacian of a surface that is deformed: never negative off the diagonal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geodesics import Mesh, embedded, stiffness
from geodesics.arrays import Floats
from geodesics.caching import cached_property
from gmds.registration.stiffness import Solver, StiffnessSystem


@dataclass(frozen=True, eq=False)
class CotangentLaplacian:
    """Cotangent weights w_ij of the edges of `mesh`, and their Laplacian L; `areas` (n,) of the vertices sum to 1."""

    mesh: Mesh
    areas: Floats

    @cached_property
    def weights(self) -> sp.csr_matrix:
        """w_ij (n, n); at an obtuse angle on the boundary the cotangent is negative, and counts as 0."""
        cotangents = sp.csr_matrix(-stiffness(embedded(self.mesh)))
        cotangents.setdiag(0)
        return sp.csr_matrix(cotangents.maximum(0))

    @cached_property
    def edges(self) -> tuple[NDArray[np.int32], NDArray[np.int32], Floats]:
        """Where the neighbours of each vertex start (n + 1,), the neighbours, and the weights of their edges."""
        return self.weights.indptr, self.weights.indices, self.weights.data

    @cached_property
    def system(self) -> StiffnessSystem:
        """The Laplacian (n, n) of these weights as a stiffness matrix."""
        laplacian = sp.diags(np.asarray(self.weights.sum(axis=1)).ravel()) - self.weights
        return StiffnessSystem(sp.csr_matrix(laplacian), self.areas)

    @property
    def matrix(self) -> sp.csr_matrix:
        """L (n, n)."""
        return self.system.matrix

    def heat_step(self, time: float) -> Solver:
        """Solves (time L + diag(areas)) y = b: an implicit step of the heat equation, for b = areas times a function.

        `time` is in units of the area of the surface.
        """
        return self.system.implicit_step(time)
