"""The linear systems of a deformation: one stiffness matrix, many weights."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from geodesics.arrays import Floats, Integers
from geodesics.caching import cached_property, memoized
from geodesics.linalg.factors import lu_factors

Solver = Callable[[Floats], Floats]

FAINT = 1e-12  # an area: weight of vertices that nothing holds, a bound, so that no system is singular
# Without supernodes, factors of 5,000 rows take 4.6 ms instead of 10 (benchmarks/results/notes.md, "Speed of a match").
SUPERNODES: dict[str, Any] = {"relax": 1, "panel_size": 1, "options": {"SymmetricMode": True}}


@dataclass(frozen=True, eq=False)
class StiffnessSystem:
    """The systems (s K + diag(weights)) y = b of one stiffness matrix K (n, n), whatever s and the weights are.

    K is symmetric and positive semidefinite. `areas` (n,) are those of the vertices.
    """

    matrix: sp.csr_matrix
    areas: Floats

    @cached_property
    def _ordered(self) -> tuple[Integers, sp.csc_matrix, Integers]:
        """An order (n,) of the vertices with little fill-in, K in that order, and where its diagonal is stored."""
        filled = (self.matrix + sp.identity(len(self.areas))).tocsc()
        columns_first = lu_factors(filled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, **SUPERNODES).perm_c
        order = np.argsort(columns_first)
        rest = (filled[order][:, order]).tocsc()
        rest.sort_indices()
        columns = np.repeat(np.arange(len(order)), np.diff(rest.indptr))
        diagonal = np.flatnonzero(rest.indices == columns)
        rest.data[diagonal] -= 1.0
        return order, rest, diagonal

    def solver(self, stiffness_weight: float, weights: Floats) -> Solver:
        """Solves (stiffness_weight K + diag(weights)) y = b; `stiffness_weight` is an area, weights (n,) are areas."""
        order, rest, diagonal = self._ordered
        matrix = rest.copy()
        matrix.data *= stiffness_weight
        matrix.data[diagonal] += weights[order] + FAINT
        solve = lu_factors(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, **SUPERNODES).solve

        def unordered(right_hand_side: Floats) -> Floats:
            result = np.empty_like(right_hand_side)
            result[order] = solve(right_hand_side[order])
            return result

        return unordered

    @memoized
    def implicit_step(self, time: float) -> Solver:
        """Solves (time K + diag(areas)) y = b: an implicit Euler step, for b = areas times a function; kept."""
        return self.solver(time, self.areas)
