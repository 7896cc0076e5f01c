"""What it costs to deform a surface in space: as rigid as possible, but for the size of its parts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from geodesics import Mesh, embedded, stiffness
from geodesics.arrays import Floats, Integers
from geodesics.caching import cached_property
from gmds._kernels.rotations import nearest_rotations

Solver = Callable[[Floats], Floats]

SIZE_TIME = 1e-3  # heat time, in units of the area, over which the local size is averaged
DOUBT = 0.05  # logarithm of a size below which the change is rather noise than growth
LARGEST = 10.0  # local size, and one over the least
FAINT = 1e-12  # weight of vertices that nothing holds
SUPERNODES: dict[str, Any] = {"relax": 1, "panel_size": 1, "options": {"SymmetricMode": True}}  # what suits so few


@dataclass(frozen=True, eq=False)
class Elasticity:
    """The energy sum_ij w_ij |y_i - y_j - s_i R_i (x_i - x_j)|^2 of moving the vertices x of `mesh` to y.

    R_i are rotations (as rigid as possible: Sorkine and Alexa 2007), s_i sizes that vary slowly (as similar as
    possible), w_ij cotangent weights, so that flat stretch costs its Dirichlet energy. `areas` (n,) of the vertices
    sum to 1.
    """

    mesh: Mesh
    areas: Floats

    @cached_property
    def _weights(self) -> sp.csr_matrix:
        """w_ij (n, n); at an obtuse angle on the boundary the cotangent is negative, and counts as 0."""
        cotangents = sp.csr_matrix(-stiffness(embedded(self.mesh)))
        cotangents.setdiag(0)
        return sp.csr_matrix(cotangents.maximum(0))

    @cached_property
    def stiffness(self) -> sp.csr_matrix:
        """The Laplace matrix (n, n) of these weights."""
        return sp.csr_matrix(sp.diags(np.asarray(self._weights.sum(axis=1)).ravel()) - self._weights)

    @cached_property
    def _rest(self) -> tuple[Floats, Floats, Floats]:
        """L x and W x (n, 3), and sum_j w_ij |x_i - x_j|^2 (n,)."""
        x = self.mesh.vertices
        return self.stiffness @ x, self._weights @ x, self._spread(x)

    @cached_property
    def _ordered(self) -> tuple[Integers, sp.csc_matrix, Integers]:
        """An order (n,) of the vertices with little fill-in, L in that order, and where its diagonal is stored."""
        filled = (self.stiffness + sp.identity(len(self.areas))).tocsc()
        found = sla.splu(filled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, **SUPERNODES).perm_c
        order = np.argsort(found)
        rest = (filled[order][:, order]).tocsc()
        rest.sort_indices()
        columns = np.repeat(np.arange(len(order)), np.diff(rest.indptr))
        diagonal = np.flatnonzero(rest.indices == columns)
        rest.data[diagonal] -= 1.0
        return order, rest, diagonal

    @cached_property
    def _solvers(self) -> dict[float, Solver]:
        return {}

    def smoother(self, time: float) -> Solver:
        """Solves (time L + diag(areas)) y = b: an implicit heat step, for b = areas times a function."""
        if time not in self._solvers:
            self._solvers[time] = self.solver(time, self.areas)
        return self._solvers[time]

    def solver(self, stiffness_weight: float, weights: Floats) -> Solver:
        """Solves (stiffness_weight L + diag(weights)) y = b; `stiffness_weight` is an area, weights (n,) are areas."""
        order, rest, diagonal = self._ordered
        matrix = rest.copy()
        matrix.data *= stiffness_weight
        matrix.data[diagonal] += weights[order] + FAINT
        solve = sla.splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, **SUPERNODES).solve

        def unordered(right: Floats) -> Floats:
            result = np.empty_like(right)
            result[order] = solve(right[order])
            return result

        return unordered

    def local_similarities(self, y: Floats, growing: bool) -> Floats:
        """The matrices s_i R_i (n, 3, 3) of least energy for vertices at y (n, 3); s_i all alike unless parts grow.

        Sizes of `growing` parts are ratios of averages over a neighbourhood, shrunk to 1 the less they differ from it:
        a surface is the same size until there is reason to believe otherwise.
        """
        similarities, sums = nearest_rotations(self._products(y))
        if not growing:
            return np.asarray(similarities * (sums.sum() / self._rest[2].sum()), dtype=np.float64)
        smooth = self.smoother(SIZE_TIME)
        size = smooth(sums) / np.maximum(smooth(self._rest[2]), FAINT)
        log = np.log(np.clip(size, 1 / LARGEST, LARGEST))
        size = np.exp(log**3 / (log**2 + DOUBT**2))
        return np.asarray(similarities * size[:, None, None], dtype=np.float64)

    def right_hand_side(self, similarities: Floats) -> Floats:
        """What L y has to be (n, 3) for the vertices that go best with the matrices (n, 3, 3)."""
        x, (lx, _, _) = self.mesh.vertices, self._rest
        around = (self._weights @ similarities.reshape(-1, 9)).reshape(-1, 3, 3)
        turned = np.einsum("nab,nb->na", similarities, x)
        return np.asarray(
            0.5 * (_apply(similarities, lx) + _apply(around, x) - self._weights @ turned), dtype=np.float64
        )

    def energy(self, y: Floats, similarities: Floats) -> Floats:
        """The energy (n,) around each vertex."""
        squares = np.einsum("nab,nab->n", similarities, similarities) / 3
        mixed = np.einsum("nba,nab->n", similarities, self._products(y))
        return np.maximum(self._spread(y) - 2 * mixed + squares * self._rest[2], 0.0)

    def _products(self, y: Floats) -> Floats:
        """sum_j w_ij (x_i - x_j)(y_i - y_j)^T, (n, 3, 3)."""
        x, wx = self.mesh.vertices, self._rest[1]
        outer = (x[:, :, None] * y[:, None, :]).reshape(-1, 9)
        products = x[:, :, None] * (self.stiffness @ y)[:, None, :] - wx[:, :, None] * y[:, None, :]
        return np.asarray(products + (self._weights @ outer).reshape(-1, 3, 3), dtype=np.float64)

    def _spread(self, y: Floats) -> Floats:
        """sum_j w_ij |y_i - y_j|^2 (n,)."""
        square = np.einsum("na,na->n", y, y)
        cross = np.einsum("na,na->n", y, self._weights @ y)
        return np.asarray(self.stiffness.diagonal() * square - 2 * cross + self._weights @ square, dtype=np.float64)


def _apply(matrices: Floats, rows: Floats) -> Floats:
    return np.asarray(np.einsum("nab,nb->na", matrices, rows), dtype=np.float64)
