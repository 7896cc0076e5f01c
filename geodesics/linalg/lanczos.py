"""Smallest eigenpairs of a sparse matrix by shift-invert block Lanczos, without restarts."""

from __future__ import annotations

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from geodesics.arrays import Floats
from geodesics.errors import EigensolverFailed
from geodesics.linalg.factors import Inverse, factorised
from geodesics.linalg.krylov import KrylovBasis

LAST_RESORT = 2000  # rows up to which a dense solver, which takes seconds there, tries what Lanczos gave up
SHIFTS = (1.0, 1e-3, 1e-6)  # shares of the shift that are tried in turn; set by hand
_BLOCK = 8  # columns; finds eigenvalues of this multiplicity, and finite groups of rotations give at most 5
_DENSE = (
    400  # rows; smaller matrices go to a dense solver. Measured with 60 eigenpairs: equally fast at 600 to 800 rows
)


def smallest_eigenpairs(
    matrix: sp.csc_matrix, count: int, *, shift: float = 1e-2, tolerance: float = 1e-8
) -> tuple[Floats, Floats]:
    """Eigenvalues (k,) ascending and orthonormal eigenvectors (n, k), k = min(count, n).

    Residuals are at most tolerance * max(lambda, 1), as far as rounding allows. `matrix` (n, n) is symmetric positive
    semi-definite; the `shift` makes it definite, and is best a tenth of the last eigenvalue. Parts of the matrix that
    are not connected are solved separately, so equal parts give multiple eigenvalues. Raises `EigensolverFailed`.
    """
    n_parts, part = sp.csgraph.connected_components(matrix, directed=False)
    if n_parts == 1:
        return _of_one_part(matrix, min(count, matrix.shape[0]), shift, tolerance)
    rows = np.split(np.argsort(part, kind="stable"), np.cumsum(np.bincount(part))[:-1])
    solved = [_of_one_part(matrix[r][:, r], min(count, len(r)), shift, tolerance) for r in rows]
    values = np.concatenate([s[0] for s in solved])
    owner = np.repeat(np.arange(n_parts), [len(s[0]) for s in solved])
    column = np.concatenate([np.arange(len(s[0])) for s in solved])
    order = np.argsort(values, kind="stable")[:count]
    vectors = np.zeros((matrix.shape[0], len(order)))
    for k, i in enumerate(order):
        vectors[rows[owner[i]], k] = solved[owner[i]][1][:, column[i]]
    return values[order], vectors


def _of_one_part(matrix: sp.csc_matrix, count: int, shift: float, tolerance: float) -> tuple[Floats, Floats]:
    n = matrix.shape[0]
    dense = n < _DENSE or 4 * count > n
    if dense and matrix.diagonal().max() < 1e9:
        return scipy.linalg.eigh(matrix.toarray(), subset_by_index=(0, count - 1))
    if not dense:
        try:
            return _with_smaller_shifts(matrix, count, shift, tolerance)
        except EigensolverFailed:
            if n > LAST_RESORT:
                raise
    shift = 1e-2
    inverse = _inverse(matrix, shift)
    # stiff (vertices all but coincide): rounding would drown the small eigenvalues, not those of the inverse
    full = inverse.solve(np.eye(n))
    values, vectors = scipy.linalg.eigh((full + full.T) / 2, subset_by_index=(n - count, n - 1))
    values = np.maximum(values[::-1], np.finfo(float).eps * values[-1])
    return 1 / values - shift, vectors[:, ::-1]


def _with_smaller_shifts(matrix: sp.csc_matrix, count: int, shift: float, tolerance: float) -> tuple[Floats, Floats]:
    """By Lanczos, with a smaller shift where eigenvalues crowd at zero: a surface much longer than wide has such."""
    for factor in SHIFTS:
        try:
            return _by_lanczos(_inverse(matrix, factor * shift), matrix.shape[0], count, factor * shift, tolerance)
        except EigensolverFailed as error:
            failed = error
    raise failed


def _inverse(matrix: sp.csc_matrix, shift: float) -> Inverse:
    n = matrix.shape[0]
    try:
        return Inverse(factorised(matrix + shift * sp.identity(n)))
    except RuntimeError as error:
        raise EigensolverFailed(f"the matrix of {n} vertices could not be factorised ({error})") from error


def _by_lanczos(inverse: Inverse, n: int, count: int, shift: float, tolerance: float) -> tuple[Floats, Floats]:
    """Smallest eigenpairs from the largest of the inverse, in a Krylov space that grows until it holds them."""
    try:
        with np.errstate(all="ignore"):  # an exhausted space shows in what comes of it
            return _iterated(inverse, n, count, shift, tolerance)
    except (np.linalg.LinAlgError, ValueError) as error:  # what is no number any more, or no basis
        raise EigensolverFailed(f"the {count} smallest eigenpairs of {n} vertices: {error}") from error


def _iterated(inverse: Inverse, n: int, count: int, shift: float, tolerance: float) -> tuple[Floats, Floats]:
    krylov = KrylovBasis(n, _BLOCK, min(n - _BLOCK, 8 * count + 50 * _BLOCK), min(1e-9, 1e-2 * tolerance))
    check = 5 * count // 2 + 2 * _BLOCK
    while krylov.room():
        krylov.grow(inverse.solve(krylov.last))
        if krylov.size < check and krylov.room():
            continue
        few = min(_BLOCK, count)  # the last ones of those wanted, which converge last
        if _converged(*krylov.ritz(count - few, count)[::2], shift, tolerance):
            values, coordinates, rest = krylov.ritz(0, count)
            if _converged(values, rest, shift, tolerance):
                return 1 / values - shift, krylov.vectors(values, coordinates, rest)
        check = krylov.size + max(_BLOCK, count // 16)
    raise EigensolverFailed(f"the {count} smallest eigenpairs of {n} vertices did not converge in {krylov.size} steps")


def _converged(values: Floats, rest: Floats, shift: float, tolerance: float) -> bool:
    """True when the residuals `rest` of the inverse make residuals of the matrix that are small enough."""
    allowed = tolerance * values**2 * np.maximum(1 / values - shift, 1.0)
    return bool(np.all(np.linalg.norm(rest, axis=0) <= allowed))
