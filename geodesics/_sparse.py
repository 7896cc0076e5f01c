"""Factorisation of sparse symmetric positive definite matrices."""

from __future__ import annotations

import scipy.sparse as sp
import scipy.sparse.linalg as sla


def factorised(matrix: sp.spmatrix) -> sla.SuperLU:
    """LU factors in symmetric mode: half the fill of the general ordering. `RuntimeError` when exactly singular."""
    return sla.splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
