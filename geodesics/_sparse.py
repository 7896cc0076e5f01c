"""Factorisation of sparse symmetric positive definite matrices."""

from __future__ import annotations

import scipy.sparse as sp
import scipy.sparse.linalg as sla


def factorised(matrix: sp.spmatrix) -> sla.SuperLU:
    """LU factors of a symmetric positive definite matrix in symmetric mode: half the fill of the general ordering.

    Where rounding leaves a matrix with stiff parts (vertices that all but coincide) singular, its diagonal is raised
    by 1e-14 of itself. Raises `RuntimeError` when that is not enough.
    """
    try:
        return _factors(matrix)
    except RuntimeError:
        return _factors(matrix + 1e-14 * sp.diags(matrix.diagonal()))


def _factors(matrix: sp.spmatrix) -> sla.SuperLU:
    return sla.splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
