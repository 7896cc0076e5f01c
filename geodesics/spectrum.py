"""Eigenpairs of the Laplace-Beltrami operator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from geodesics.arguments import whole_number
from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import memoized
from geodesics.errors import EigensolverFailed
from geodesics.laplacian import lumped_mass, stiffness
from geodesics.linalg.lanczos import smallest_eigenpairs
from geodesics.mesh import Mesh
from geodesics.metric import Metric, as_metric
from geodesics.threads import on_one_blas_thread

# Shift of the Laplacian per eigenpair, in units of 1 / area; by Weyl's law, 4 pi of these units per eigenpair, it is a
# twentieth of the last eigenvalue. Not sensitive: 200 eigenpairs of 5,000 vertices take 73 to 79 steps with 0.1 to 2.4.
SHIFT = 0.6
# Entry of the stiffness matrix, about 1 in even meshes, of an edge that is as good as no edge: a bound. A needle of
# this aspect has it; eigenfunctions change along such an edge by its inverse.
STIFF = 1e6
HIGHEST = 1e100  # an eigenfunction of mean square 1: a bound, beyond which products of two overflow soon
USUAL = 100  # eigenpairs where nobody said how many; set by hand, as many as `match` computes in the metric of space


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

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> spectrum = geodesics.eigenpairs(sphere, 4)
    >>> abs(spectrum.eigenvalues.round(1)).tolist(), spectrum.eigenfunctions.shape
    ([0.0, 2.0, 2.0, 2.0], (162, 4))
    """

    mesh: Mesh
    mass: Floats
    eigenvalues: Floats
    eigenfunctions: Floats

    def __repr__(self) -> str:
        values = f" from {self.eigenvalues[0]:.3g} to {self.eigenvalues[-1]:.3g}" if len(self.eigenvalues) else ""
        return f"Spectrum({len(self.eigenvalues)} eigenvalues{values} on {self.mesh!r})"


def as_spectrum(spectrum: Any) -> Spectrum:
    """The spectrum that it is; of a metric, or a mesh with its embedded metric, the first `USUAL` eigenpairs.

    These are kept with what they were computed of. Raises `TypeError` for anything else.
    """
    if all(hasattr(spectrum, name) for name in ("mesh", "mass", "eigenvalues", "eigenfunctions")):
        return spectrum  # type: ignore[no-any-return]
    try:
        metric = spectrum if isinstance(spectrum, (Metric, Mesh)) else as_metric(spectrum)
    except TypeError:
        kind = type(spectrum).__name__
        raise TypeError(f"a spectrum is expected, not {kind}; for example geodesics.eigenpairs(mesh, 100)") from None
    return _usual(metric)


@memoized
def _usual(metric: Metric | Mesh) -> Spectrum:
    """The first `USUAL` eigenpairs."""
    return eigenpairs(metric, USUAL)


@on_one_blas_thread
def eigenpairs(
    metric: Metric | Mesh,
    count: int = USUAL,
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
        The metric, on a mesh of n vertices; of a mesh the embedded one.
    count : int
        Number of eigenpairs; a mesh with fewer free vertices, or places where they are, gives as many as it has.
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

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> values = geodesics.eigenpairs(geodesics.embedded(sphere), 9).eigenvalues
    >>> abs(values.round(1)).tolist()  # k (k + 1), but for the edges
    [0.0, 2.0, 2.0, 2.0, 5.9, 5.9, 5.9, 5.9, 5.9]
    """
    count = whole_number(count, "count", 1)
    metric = as_metric(metric)
    area, n = metric.mass.sum(), metric.mesh.n_vertices
    free = np.flatnonzero(metric.mass > 0 if fixed is None else (metric.mass > 0) & ~fixed)
    if len(free) == 0:
        return Spectrum(metric.mesh, metric.mass, np.zeros(0), np.zeros((n, 0)))
    a, b = stiffness(metric)[free][:, free], mass(metric).tocsr()[free][:, free] / area  # unit area: no unit of length
    if not (np.all(np.isfinite(a.data)) and np.all(np.isfinite(b.data))):
        raise EigensolverFailed("the stiffness or mass matrix is not finite")
    groups = stiff_groups(a)
    if groups is None:
        values, vectors = _generalised(a, b, min(count, len(free)), tolerance)
    else:
        joined = sp.csr_matrix((np.ones(len(free)), (np.arange(len(free)), groups)))
        a = _without_inner_links(a, joined, free=fixed is None)
        values, vectors = _generalised(a, joined.T @ b @ joined, min(count, a.shape[0]), tolerance)
        vectors = joined @ vectors
    if not np.abs(vectors).max(initial=0.0) < HIGHEST:
        raise EigensolverFailed(
            f"eigenfunctions of {n} vertices are beyond {HIGHEST:.0e} where faces have all but collapsed: are "
            "coordinates too coarse for the size of the surface, as in single precision far from the origin?"
        )
    functions = np.zeros((n, len(values)))
    functions[free] = vectors / np.sqrt(area)
    return Spectrum(metric.mesh, metric.mass, np.maximum(values, 0) / area, functions)


def stiff_groups(a: sp.csr_matrix) -> Integers | None:
    """For the vertices (n,) of a stiffness matrix the numbers of groups that all but coincide; None where none do.

    Differences within a group belong to the largest eigenvalues, and rounding of these would drown the smallest: all
    of it takes one value.
    """
    links = sp.coo_matrix(sp.triu(a, 1))
    stiff = -links.data > STIFF
    if not stiff.any():
        return None
    graph = sp.coo_matrix((links.data[stiff], (links.row[stiff], links.col[stiff])), shape=a.shape)
    return np.asarray(sp.csgraph.connected_components(graph, directed=False)[1], dtype=np.int64)


def _without_inner_links(a: sp.csr_matrix, joined: sp.csr_matrix, *, free: bool) -> sp.csr_matrix:
    """The stiffness matrix of groups, whose rows sum to 0 where nothing is fixed, exactly: large entries cancel."""
    between = (joined.T @ a @ joined).tolil()
    between.setdiag(0)
    between = between.tocsr()
    sums = 0.0 if free else joined.T @ np.asarray(a.sum(axis=1)).ravel()
    return sp.csr_matrix(between + sp.diags(sums - np.asarray(between.sum(axis=1)).ravel()))


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
