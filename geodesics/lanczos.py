"""Smallest eigenpairs of a sparse matrix by shift-invert block Lanczos, without restarts."""

from __future__ import annotations

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from numpy.typing import NDArray

from geodesics._sparse import factorised
from geodesics.errors import EigensolverFailed

Array = NDArray[np.float64]
_BLOCK = 6  # finds eigenvalues of this multiplicity: those of the sphere's finite subgroups have at most 5
_DENSE = 400  # below this size a dense solver is as fast


def smallest_eigenpairs(
    matrix: sp.csc_matrix, count: int, *, shift: float = 1e-2, tolerance: float = 1e-8
) -> tuple[Array, Array]:
    """Eigenvalues (k,) ascending and orthonormal eigenvectors (n, k), k = min(count, n).

    Residuals are at most tolerance * lambda. `matrix` (n, n) is symmetric positive semi-definite, with the wanted
    eigenvalues large against `shift`. Parts of it that are not linked are solved apart, so equal parts give multiple
    eigenvalues. Raises `EigensolverFailed`.
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


def _of_one_part(matrix: sp.csc_matrix, count: int, shift: float, tolerance: float) -> tuple[Array, Array]:
    n = matrix.shape[0]
    dense = n < _DENSE or 4 * count > n
    if dense and matrix.diagonal().max() < 1e9:
        return scipy.linalg.eigh(matrix.toarray(), subset_by_index=(0, count - 1))
    try:
        factor = factorised(matrix + shift * sp.identity(n))
    except RuntimeError as error:
        raise EigensolverFailed(f"the matrix of {n} vertices could not be factorised ({error})") from error
    if dense:  # stiff (vertices all but coincide): rounding would drown the small eigenvalues, not those of the inverse
        full = factor.solve(np.eye(n))
        inverse, vectors = scipy.linalg.eigh((full + full.T) / 2, subset_by_index=(n - count, n - 1))
        inverse, vectors = np.maximum(inverse[::-1], np.finfo(float).eps * inverse[-1]), vectors[:, ::-1]
    else:
        inverse, vectors = _largest_of_inverse(factor, n, count, tolerance)
    return 1 / inverse - shift, vectors


def _largest_of_inverse(factor: sla.SuperLU, n: int, count: int, tolerance: float) -> tuple[Array, Array]:
    """Largest eigenpairs of the inverse, descending: block Lanczos with full reorthogonalisation by matrix products."""
    b, capacity = _BLOCK, min(n - _BLOCK, 8 * count + 50 * _BLOCK)
    random = np.random.default_rng(0)
    basis = np.empty((n, capacity + b), order="F")
    tridiagonal = np.zeros((capacity + b, capacity + b))  # block tridiagonal, lower half
    basis[:, :b] = np.linalg.qr(random.standard_normal((n, b)))[0]
    size, check = 0, 5 * count // 2 + 4 * b
    while size + b <= capacity:
        image = factor.solve(basis[:, size : size + b])
        near = basis[:, max(size - b, 0) : size + b]
        overlap = near.T @ image
        image -= near @ overlap
        tridiagonal[size : size + b, size : size + b] = overlap[-b:]
        size += b
        following, link = _orthonormal(image, basis[:, :size], random)
        if size >= check or size + b > capacity:
            found = scipy.linalg.eigh(
                tridiagonal[:size, :size], subset_by_index=(size - count, size - 1), driver="evr", lower=True
            )
            values, coordinates = found[0][::-1], found[1][:, ::-1]
            rest = link @ coordinates[-b:]  # the residual, in the basis of `following`
            if np.all(np.linalg.norm(rest, axis=0) <= tolerance * values):
                # one more power of the inverse costs nothing: it takes the vectors to
                # basis * coordinates * values + following * rest
                return values, basis[:, :size] @ coordinates + following @ (rest / values)
            check = size + max(b, count // 8)
        basis[:, size : size + b] = following
        tridiagonal[size : size + b, size - b : size] = link
    raise EigensolverFailed(f"the {count} smallest eigenpairs of {n} vertices did not converge in {size} steps")


def _orthonormal(image: Array, basis: Array, random: np.random.Generator) -> tuple[Array, Array]:
    """The part of `image` outside `basis` as an orthonormal block times a triangular factor."""
    size = np.linalg.norm(image, axis=0)
    image -= basis @ (basis.T @ image)
    block, link = np.linalg.qr(image)
    left = np.abs(np.diag(link)) / max(size.max(), np.finfo(float).tiny)
    if left.min() > 1e-6:
        return block, link
    # hardly anything new: clean what there is, and where there is nothing go on in a random direction
    lost = left <= 1e-13
    block[:, lost] = random.standard_normal((len(image), np.count_nonzero(lost)))
    for _ in range(2):
        block -= basis @ (basis.T @ block)
        block, _ = np.linalg.qr(block)
    return block, block.T @ image
