"""Eigenpairs of the Laplace-Beltrami operator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from geodesics.arrays import Bools, Floats
from geodesics.errors import EigensolverFailed
from geodesics.laplacian import lumped_mass, stiffness
from geodesics.linalg.lanczos import smallest_eigenpairs
from geodesics.mesh import Mesh
from geodesics.metric import Metric
from geodesics.threads import on_one_blas_thread

# Shift of the Laplacian per eigenpair, in units of 1 / area; by Weyl's law, 4 pi of these units per eigenpair, it is a
# twentieth of the last eigenvalue. Not sensitive: 200 eigenpairs of 5,000 vertices take 73 to 79 steps with 0.1 to 2.4.
SHIFT = 0.6


@dataclass(frozen=True, eq=False)
class Spectrum:
    r"""Eigenvalues and eigenfunctions of the Laplace-Beltrami operator in some metric.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.
    mass : array of shape (n,)
        Lumped mass: integrals over the surface are ``mass @ values``.
    eigenvalues : array of shape (k,)
        :math:`\lambda_i`, ascending from 0, in units of 1 / area.
    eigenfunctions : array of shape (n, k)
        :math:`\phi_i` in columns, orthonormal in the mass matrix that they were computed with.

    See Also
    --------
    eigenpairs : Computes them.
    DiffusionDistance, CommuteTimeDistance, BiharmonicDistance : Distances made of them.
    """

    mesh: Mesh
    mass: Floats
    eigenvalues: Floats
    eigenfunctions: Floats


@on_one_blas_thread
def eigenpairs(
    metric: Metric,
    count: int,
    *,
    mass: Callable[[Metric], sp.spmatrix] = lumped_mass,
    fixed: Bools | None = None,
    tolerance: float = 1e-8,
) -> Spectrum:
    r"""The smallest eigenpairs of the Laplace-Beltrami operator (sec. 4, (4.4)), the same from run to run.

    .. math:: A \, \alpha = \lambda \, B \, \alpha

    Parameters
    ----------
    metric : Metric
        The metric, on a mesh of n vertices.
    count : int
        Number of eigenpairs; a mesh with fewer free vertices gives as many as it has.
    mass : callable
        Makes B from the metric: `lumped_mass` or `galerkin_mass`.
    fixed : bool array of shape (n,), optional
        Vertices where functions vanish (Dirichlet), for instance ``boundary_vertices(mesh)``; the rest of the boundary
        is free (Neumann).
    tolerance : float
        Residuals, in the norm of the mass, are at most this times the eigenvalue (times 1 / area for smaller ones), as
        far as rounding allows: about 1e-16 of the largest eigenvalue of the matrices.

    Returns
    -------
    Spectrum
        Vertices without mass (on no face) have zero rows.

    Raises
    ------
    ValueError
        When `count` is less than 1.
    EigensolverFailed
        E402 when the iteration does not converge.

    References
    ----------
    (4.4) of Aflalo, Kimmel, Raviv 2013; Simon: The Lanczos algorithm with partial reorthogonalization (1984).

    See Also
    --------
    stiffness, lumped_mass, galerkin_mass : The matrices A and B.
    """
    if count < 1:
        raise ValueError(f"count must be at least 1, not {count}")
    area, n = metric.mass.sum(), metric.mesh.n_vertices
    free = np.flatnonzero(metric.mass > 0 if fixed is None else (metric.mass > 0) & ~fixed)
    if len(free) == 0:
        return Spectrum(metric.mesh, metric.mass, np.zeros(0), np.zeros((n, 0)))
    a, b = stiffness(metric)[free][:, free], mass(metric).tocsr()[free][:, free] / area  # unit area: no unit of length
    if not (np.all(np.isfinite(a.data)) and np.all(np.isfinite(b.data))):
        raise EigensolverFailed("the stiffness or mass matrix is not finite")
    values, vectors = _generalised(a, b, min(count, len(free)), tolerance)
    functions = np.zeros((n, len(values)))
    functions[free] = vectors / np.sqrt(area)
    return Spectrum(metric.mesh, metric.mass, np.maximum(values, 0) / area, functions)


def _generalised(a: sp.csr_matrix, b: sp.csr_matrix, count: int, tolerance: float) -> tuple[Floats, Floats]:
    """The smallest eigenpairs of A x = lambda B x, ascending, x orthonormal in B."""
    if b.nnz == b.shape[0]:
        root = 1 / np.sqrt(b.diagonal())
        matrix = (sp.diags(root) @ a @ sp.diags(root)).tocsc()
        values, vectors = smallest_eigenpairs(matrix, count, shift=SHIFT * count, tolerance=tolerance)
        return values, root[:, None] * vectors
    n = a.shape[0]
    if n < 400 or 4 * count > n:
        return scipy.linalg.eigh(a.toarray(), b.toarray(), subset_by_index=(0, count - 1))
    try:
        start = np.random.default_rng(0).standard_normal(n)  # ones would miss eigenfunctions of symmetric surfaces
        values, vectors = sla.eigsh(a.tocsc(), count, b.tocsc(), sigma=-1e-2, v0=start, tol=1e-3 * tolerance)
    except (RuntimeError, sla.ArpackError) as error:
        raise EigensolverFailed(f"the {count} smallest eigenpairs of {n} vertices were not found ({error})") from error
    order = np.argsort(values)
    return values[order], vectors[:, order]
