"""Finite elements of the Laplace-Beltrami operator."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geodesics import intrinsic
from geodesics.delaunay import IntrinsicTriangulation, intrinsic_delaunay
from geodesics.metric import Metric

Array = NDArray[np.float64]


def cotangent_matrix(triangulation: IntrinsicTriangulation, n: int) -> sp.csr_matrix:
    """The positive semi-definite cotangent matrix W (n, n)."""
    faces, l_sq = triangulation
    half_cot = 0.5 * intrinsic.cotangents(l_sq)
    i, j = faces[:, [1, 2, 0]], faces[:, [2, 0, 1]]
    off = sp.coo_matrix((-half_cot.ravel(), (i.ravel(), j.ravel())), shape=(n, n))
    off = (off + off.T).tocsr()
    return (off - sp.diags(np.asarray(off.sum(axis=1)).ravel())).tocsr()


def vertex_areas(triangulation: IntrinsicTriangulation, n: int) -> Array:
    """A third of the area of the faces around each vertex, shape (n,)."""
    area = intrinsic.areas(triangulation.l_sq)
    return np.bincount(triangulation.faces.ravel(), np.repeat(area / 3, 3), minlength=n)


def stiffness(metric: Metric) -> sp.csr_matrix:
    """The positive semi-definite stiffness matrix (n, n) of sec. 4, (4.4)."""
    if metric.conformal_factor is not None:  # the Dirichlet energy is conformally invariant
        return cotangent_matrix(intrinsic_delaunay(metric.mesh), metric.mesh.n_vertices)
    return cotangent_matrix(IntrinsicTriangulation(metric.mesh.faces, metric.l_sq), metric.mesh.n_vertices)


def lumped_mass(metric: Metric) -> sp.dia_matrix:
    """The diagonal mass matrix (n, n)."""
    return sp.diags(metric.mass)
