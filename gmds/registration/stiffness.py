"""The linear systems of a deformation: one stiffness matrix, many weights."""

from __future__ import annotations

from dataclasses import dataclass

import scipy.sparse as sp

from geodesics.arrays import Floats
from geodesics.caching import cached_property, memoized
from geodesics.linalg.ldl import ShiftedSystems, Solver

FAINT = 1e-12  # an area: weight of vertices that nothing holds, a bound, so that no system is singular


@dataclass(frozen=True, eq=False)
class StiffnessSystem:
    """The systems (s K + diag(weights)) y = b of one stiffness matrix K (n, n), whatever s and the weights are.

    K is symmetric and positive semidefinite. `areas` (n,) are those of the vertices.
    """

    matrix: sp.csr_matrix
    areas: Floats

    @cached_property
    def _systems(self) -> ShiftedSystems:
        return ShiftedSystems(self.matrix)

    def solver(self, stiffness_weight: float, weights: Floats) -> Solver:
        """Solves (stiffness_weight K + diag(weights)) y = b; `stiffness_weight` is an area, weights (n,) are areas."""
        return self._systems.solver(stiffness_weight, weights + FAINT)

    @memoized
    def implicit_step(self, time: float) -> Solver:
        """Solves (time K + diag(areas)) y = b: an implicit Euler step, for b = areas times a function; kept."""
        return self.solver(time, self.areas)
