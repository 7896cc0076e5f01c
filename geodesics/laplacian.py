"""Finite elements of the Laplace-Beltrami operator (sec. 4)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geodesics import intrinsic
from geodesics.delaunay import IntrinsicTriangulation, intrinsic_delaunay
from geodesics.mesh import Mesh

if TYPE_CHECKING:
    from geodesics.metric import Metric

Array = NDArray[np.float64]


def cotangent_matrix(triangulation: IntrinsicTriangulation, n: int, conductivity: Array | None = None) -> sp.csr_matrix:
    """The positive semi-definite matrix W (n, n) with off-diagonal entries -(cot alpha + cot beta) / 2.

    This is a_kl of (4.4) for the metric that the squared edge lengths describe. Any faces will do: an edge may have
    one face (free boundary: Neumann), two, or more. With a conductivity c (m,) per face: the matrix of -div(c grad).
    """
    faces, l_sq = triangulation
    half_cot = 0.5 * intrinsic.cotangents(l_sq)
    if conductivity is not None:
        half_cot *= conductivity[:, None]
    i, j = faces[:, [1, 2, 0]], faces[:, [2, 0, 1]]
    off = sp.coo_matrix((-half_cot.ravel(), (i.ravel(), j.ravel())), shape=(n, n))
    off = (off + off.T).tocsr()
    return (off - sp.diags(np.asarray(off.sum(axis=1)).ravel())).tocsr()


def vertex_areas(triangulation: IntrinsicTriangulation, n: int) -> Array:
    """A third of the area of the faces around each vertex, shape (n,)."""
    return vertex_sums(triangulation.faces, intrinsic.areas(triangulation.l_sq) / 3, n)


def vertex_sums(faces: NDArray[np.int64], values: Array, n: int) -> Array:
    """Sum over the faces around each vertex, shape (n,), of values per face (m,) or per corner (m, 3)."""
    corners = np.broadcast_to(values[:, None] if values.ndim == 1 else values, faces.shape)
    return np.bincount(faces.ravel(), corners.ravel(), minlength=n).astype(np.float64)


def stiffness(metric: Metric) -> sp.csr_matrix:
    """The positive semi-definite stiffness matrix a_kl (n, n) of (4.4), with free (Neumann) boundary.

    In two dimensions the Dirichlet energy is conformally invariant: for rho * g it is the cotangent matrix of g,
    taken here on the intrinsic Delaunay triangulation, where its off-diagonal entries are never positive.
    """
    if metric.conformal_factor is not None:
        return cotangent_matrix(intrinsic_delaunay(metric.mesh), metric.mesh.n_vertices)
    return cotangent_matrix(IntrinsicTriangulation(metric.mesh.faces, metric.l_sq), metric.mesh.n_vertices)


def tensor_stiffness(faces: NDArray[np.int64], tensor: Array, n: int) -> sp.csr_matrix:
    """The stiffness matrix a_kl (n, n) of (4.4) for a metric tensor g_ij (m, 2, 2) per face.

    a_kl sums g^ij (d_i psi_l) (d_j psi_k) sqrt(det g) / 2 over faces, in barycentric coordinates (see `intrinsic`).
    Equals `cotangent_matrix` of the lengths that the tensor gives; it is the formula as the paper writes it.
    """
    gradient = np.array([[-1.0, -1], [1, 0], [0, 1]])  # of psi_0, psi_1, psi_2 in (u, v)
    area = 0.5 * np.sqrt(np.linalg.det(tensor))
    element = gradient @ np.linalg.inv(tensor) @ gradient.T * area[:, None, None]
    return _assembled(faces, element, n)


def lumped_mass(metric: Metric) -> sp.dia_matrix:
    """The diagonal mass matrix (n, n): b_kl of (4.4) summed over each row."""
    return sp.diags(metric.mass)


def galerkin_mass(metric: Metric) -> sp.csr_matrix:
    """The full mass matrix b_kl (n, n) of (4.4), the integral of psi_k psi_l; rho * g takes rho linear on faces."""
    n = metric.mesh.n_vertices
    pattern = np.ones((3, 3)) + np.eye(3)
    if metric.conformal_factor is None:
        area = intrinsic.areas(metric.l_sq)
        return _assembled(metric.mesh.faces, area[:, None, None] / 12 * pattern, n)
    faces, l_sq = intrinsic_delaunay(metric.mesh)
    rho = metric.conformal_factor[faces]
    weight = rho.sum(axis=1)[:, None, None] + rho[:, :, None] + rho[:, None, :]  # 60 x integral of psi_k psi_l rho
    return _assembled(faces, intrinsic.areas(l_sq)[:, None, None] / 60 * weight * pattern, n)


def cotangent_operator(mesh: Mesh, epsilon: float) -> sp.csr_matrix:
    """The operator L = K^-1 A^-1 W (n, n) of (4.5) to the letter.

    A_ii is the area of the whole one-ring, W has cot alpha + cot beta without the half, and
    |K_i| = sqrt((3 defect_i / A_ii)^2 + epsilon), with epsilon in units of 1 / length^4. So L is 2/3 of the consistent
    operator, is not symmetric, and changes with the unit of length through epsilon. Vertices on no face get zero rows.
    For eigenpairs use `eigenpairs(scale_invariant(mesh), count)`.
    """
    from geodesics.curvature import one_ring_areas, one_ring_curvature

    w = 2 * cotangent_matrix(IntrinsicTriangulation(mesh.faces, _embedded_lengths(mesh)), mesh.n_vertices)
    weight = one_ring_areas(mesh) * np.sqrt(one_ring_curvature(mesh) ** 2 + epsilon)
    return (sp.diags(np.divide(1, weight, out=np.zeros_like(weight), where=weight > 0)) @ w).tocsr()


def _embedded_lengths(mesh: Mesh) -> Array:
    return intrinsic.squared_lengths(mesh.vertices, mesh.faces)


def _assembled(faces: NDArray[np.int64], element: Array, n: int) -> sp.csr_matrix:
    """Sum of element matrices (m, 3, 3) into a sparse matrix (n, n)."""
    i, j = np.repeat(faces, 3, axis=1), np.tile(faces, 3)
    return sp.coo_matrix((element.ravel(), (i.ravel(), j.ravel())), shape=(n, n)).tocsr()
