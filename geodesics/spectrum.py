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

SHIFT = 0.6
"""Of the Laplacian for each eigenpair, in units of 1 / area: a fortieth of the last eigenvalue by Weyl's law."""


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Eigenvalues (count,) ascending from 0, in units of 1 / area, and eigenfunctions (n, count).

    Eigenfunctions are orthonormal in the mass matrix; `mass` (n,) is the lumped one: integrals over the surface
    are `mass @ values`.
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
    """The `count` smallest eigenpairs of A alpha = lambda B alpha (sec. 4, (4.4)), repeatable from run to run.

    `mass` makes B: `lumped_mass` or `galerkin_mass`. The boundary is free (Neumann); functions vanish where `fixed`
    (n,) is True (Dirichlet: `fixed=boundary_vertices(mesh)`). Vertices without mass (on no face) get zero rows; a mesh
    with fewer free vertices than `count` gives as many eigenpairs as it has. Residuals, in the norm of the mass, are at
    most `tolerance` times the eigenvalue (times 1 / area for those below it), as far as rounding lets them: about 1e-16
    of the largest eigenvalue. Raises `EigensolverFailed` (E402).
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
