"""Factorisation of sparse symmetric positive definite matrices."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from geodesics._kernels.substitution import WIDTH, Triangle, substitute
from geodesics.arrays import Floats
from geodesics.errors import SingularMatrix
from geodesics.linalg.dissection import nested_dissection

# Rows from which matrices are put in the order of nested dissection. With the time for the order it is as fast as
# minimum degree at 80,000 rows already (0.66 against 0.73 s), but makes 1.7 times as many entries there.
LARGE = 200_000
# Shares of the diagonal by which it is raised where rounding left nothing of a pivot. The first is the rounding error
# of a row, the last its root, beyond which solutions would be of another problem.
RAISES = (0.0, 1e-14, 1e-11, 1e-8)


class Factors:
    """A solved system: `solve(b)` gives A^-1 b. Above 200,000 rows A is put in the order of nested dissection first."""

    def __init__(self, matrix: sp.spmatrix) -> None:
        n = matrix.shape[0]
        self.order = nested_dissection(matrix) if n >= LARGE else np.arange(n)
        if n >= LARGE:
            matrix = matrix.tocsr()[self.order][:, self.order]
        self.lu = lu_factors(
            matrix.tocsc(),
            permc_spec="NATURAL" if n >= LARGE else "MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )

    def solve(self, right: Floats) -> Floats:
        """A^-1 right, (n,) or (n, k)."""
        solved = np.empty(right.shape)
        solved[self.order] = self.lu.solve(right[self.order])
        return solved


def factorised(matrix: sp.spmatrix) -> Factors:
    """LU factors of a symmetric positive definite matrix in symmetric mode: half the fill of the general ordering.

    As `lu_factors`, it raises `SingularMatrix` (E404).
    """
    return Factors(matrix)


def lu_factors(matrix: sp.csc_matrix, **options: Any) -> Any:
    """What `scipy.sparse.linalg.splu` makes of a symmetric positive definite matrix (n, n), with the options of that.

    Where rounding leaves a matrix with stiff parts (vertices that all but coincide) singular, its diagonal is raised by
    as little of itself, and of its median, as helps. Raises `SingularMatrix` (E404) when nothing does.
    """
    diagonal = matrix.diagonal()
    for share in RAISES:
        raised = matrix if share == 0 else (matrix + share * sp.diags(diagonal + np.median(diagonal))).tocsc()
        try:
            return sla.splu(raised, **options)
        except RuntimeError as error:
            reason = error
    raise SingularMatrix(unsolvable(len(diagonal), reason)) from reason


def unsolvable(count: int, reason: object) -> str:
    """Why a system of so many unknowns has no solution, and what to do."""
    return (
        f"a system of {count} unknowns cannot be solved ({reason}): vertices coincide or lie on lines; "
        "weld and simplify the mesh, or store its coordinates with more digits"
    )


class Inverse:
    """The inverse of a symmetric matrix from its factors, applied to many right-hand sides: twice as fast as SuperLU.

    With Pr A Pc = L U and A symmetric, A x = b is U^T L^T Pr x = Pc^T b.
    """

    def __init__(self, factors: Factors) -> None:
        lower, upper = factors.lu.L, factors.lu.U
        for triangle in (lower, upper):
            triangle.sort_indices()
        self._upper = Triangle(upper.indptr, upper.indices, upper.data)
        self._lower = Triangle(lower.indptr, lower.indices, lower.data)
        self._from = factors.order[np.argsort(factors.lu.perm_c)]
        self._to = factors.lu.perm_r[np.argsort(factors.order)]

    def solve(self, block: Floats) -> Floats:
        """A^-1 block (n, k), in Fortran order."""
        out = np.empty(block.shape, order="F")
        for k in range(0, block.shape[1], WIDTH):
            part = block[:, k : k + WIDTH]
            work = np.zeros((len(part), WIDTH))
            work[:, : part.shape[1]] = part
            work = work[self._from]
            substitute(self._upper, self._lower, work)
            out[:, k : k + WIDTH] = work[self._to][:, : part.shape[1]]
        return out
