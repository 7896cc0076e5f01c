"""Eigenpairs of the Laplace-Beltrami operator."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from numpy.typing import NDArray

from geodesics.errors import EigensolverFailed
from geodesics.laplacian import stiffness
from geodesics.mesh import Mesh
from geodesics.metric import Metric

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Eigenvalues (count,) ascending from 0, in units of 1 / area, and mass-orthonormal eigenfunctions (n, count)."""

    mesh: Mesh
    mass: Array
    eigenvalues: Array
    eigenfunctions: Array


def eigenpairs(metric: Metric, count: int) -> Spectrum:
    """The `count` smallest eigenpairs of W phi = lambda M phi (sec. 4, (4.4)), repeatable from run to run.

    Vertices without mass (on no face) get zero rows. A mesh with fewer than `count` vertices yields as many
    eigenpairs as it has. Raises `EigensolverFailed` (E402) when the iteration does not converge.
    """
    if count < 1:
        raise ValueError(f"count must be at least 1, not {count}")
    used = np.flatnonzero(metric.mass > 0)
    area = metric.mass.sum()
    root = np.sqrt(metric.mass[used] / area)  # unit area inside: nothing below depends on the size of the surface
    normal = sp.diags(1 / root) @ stiffness(metric)[used][:, used] @ sp.diags(1 / root)
    values, vectors = _smallest(normal.tocsc(), min(count, len(used)))
    functions = np.zeros((metric.mesh.n_vertices, len(values)))
    functions[used] = vectors / (root * np.sqrt(area))[:, None]
    return Spectrum(metric.mesh, metric.mass, np.maximum(values, 0) / area, functions)


def _smallest(matrix: sp.csc_matrix, count: int) -> tuple[Array, Array]:
    """The smallest eigenpairs of a symmetric positive semi-definite matrix, ascending."""
    n = matrix.shape[0]
    if count > n // 3 or n < 100:
        values, vectors = scipy.linalg.eigh(matrix.toarray(), subset_by_index=(0, count - 1))
        return values, vectors
    start = np.random.default_rng(0).standard_normal(n)
    try:
        values, vectors = sla.eigsh(matrix, count, sigma=-1e-2, v0=start)
    except (RuntimeError, sla.ArpackError) as error:
        raise EigensolverFailed(f"the {count} smallest eigenpairs of {n} vertices were not found ({error})") from error
    order = np.argsort(values)
    return values[order], vectors[:, order]
