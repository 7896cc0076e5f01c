"""Finite elements of the Laplace-Beltrami operator (sec. 4)."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from geodesics import intrinsic
from geodesics.arrays import Floats, Integers
from geodesics.delaunay import IntrinsicTriangulation, intrinsic_delaunay
from geodesics.mesh import Mesh
from geodesics.metric import Metric, as_metric
from geodesics.moved_paths import names_moved


def cotangent_matrix(
    triangulation: IntrinsicTriangulation, n: int, conductivity: Floats | None = None
) -> sp.csr_matrix:
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


def stiffness(metric: Metric | Mesh) -> sp.csr_matrix:
    r"""The stiffness matrix of (4.4), with free (Neumann) boundary.

    .. math:: a_{kl} = \int_S \langle \nabla \psi_k, \nabla \psi_l \rangle \, da
              = - \tfrac12 (\cot \alpha_{kl} + \cot \beta_{kl}) \quad (k \ne l)

    In two dimensions the Dirichlet energy is conformally invariant: for a metric :math:`\rho g` it is the cotangent
    matrix of g, taken here on the intrinsic Delaunay triangulation, where no off-diagonal entry is positive.

    Parameters
    ----------
    metric : Metric
        The metric, on a mesh of n vertices.

    Returns
    -------
    sparse matrix of shape (n, n)
        Symmetric and positive semi-definite; it has no unit.

    See Also
    --------
    lumped_mass, galerkin_mass : The other side of the eigenproblem.
    eigenpairs : Its solutions.

    Examples
    --------
    >>> import geodesics
    >>> triangle = geodesics.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    >>> (24 * geodesics.stiffness(triangle)).toarray().round(6).tolist()  # rows sum to 0
    [[25.0, -16.0, -9.0], [-16.0, 16.0, 0.0], [-9.0, 0.0, 9.0]]
    """
    metric = as_metric(metric)
    if metric.conformal_factor is not None:
        return cotangent_matrix(intrinsic_delaunay(metric.mesh), metric.mesh.n_vertices)
    return cotangent_matrix(IntrinsicTriangulation(metric.mesh.faces, metric.l_sq), metric.mesh.n_vertices)


def tensor_stiffness(faces: Integers, tensor: Floats, n: int) -> sp.csr_matrix:
    r"""The stiffness matrix of (4.4) as the paper writes it, for a metric tensor per face.

    .. math:: a_{kl} = \sum_{\text{faces}} \tfrac12 \sqrt{\det g} \; g^{ij} \, \partial_i \psi_l \, \partial_j \psi_k

    Derivatives are those of barycentric coordinates (see `geodesics.intrinsic`). Equals `cotangent_matrix` of the
    lengths that the tensor gives.

    Parameters
    ----------
    faces : int array of shape (m, 3)
        Triangles.
    tensor : array of shape (m, 2, 2)
        The metric tensor :math:`g_{ij}` of each.
    n : int
        Number of vertices.

    Returns
    -------
    sparse matrix of shape (n, n)
        Symmetric and positive semi-definite.
    """
    gradient = np.array([[-1.0, -1], [1, 0], [0, 1]])  # of psi_0, psi_1, psi_2 in (u, v)
    area = 0.5 * np.sqrt(np.linalg.det(tensor))
    element = gradient @ np.linalg.inv(tensor) @ gradient.T * area[:, None, None]
    return _assembled(faces, element, n)


def lumped_mass(metric: Metric | Mesh) -> sp.dia_matrix:
    """The diagonal mass matrix: :math:`b_{kl}` of (4.4) summed over each row.

    Parameters
    ----------
    metric : Metric
        The metric, on a mesh of n vertices.

    Returns
    -------
    sparse matrix of shape (n, n)
        ``metric.mass`` on the diagonal, in units of area.

    See Also
    --------
    galerkin_mass : Before rows are summed.

    Examples
    --------
    >>> import geodesics
    >>> triangle = geodesics.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    >>> geodesics.lumped_mass(triangle).diagonal().tolist()  # thirds of the area
    [2.0, 2.0, 2.0]
    """
    metric = as_metric(metric)
    return sp.diags(metric.mass)


def galerkin_mass(metric: Metric | Mesh) -> sp.csr_matrix:
    r"""The full mass matrix of (4.4).

    .. math:: b_{kl} = \int_S \psi_k \psi_l \, da

    In a metric :math:`\rho g` the factor is taken as linear on faces.

    Parameters
    ----------
    metric : Metric
        The metric, on a mesh of n vertices.

    Returns
    -------
    sparse matrix of shape (n, n)
        Symmetric and positive definite, in units of area.

    See Also
    --------
    lumped_mass : Its rows summed to the diagonal.

    Examples
    --------
    >>> import geodesics
    >>> triangle = geodesics.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    >>> geodesics.galerkin_mass(triangle).toarray().tolist()
    [[1.0, 0.5, 0.5], [0.5, 1.0, 0.5], [0.5, 0.5, 1.0]]
    """
    metric = as_metric(metric)
    n = metric.mesh.n_vertices
    pattern = np.ones((3, 3)) + np.eye(3)
    if metric.conformal_factor is None:
        area = intrinsic.areas(metric.l_sq)
        return _assembled(metric.mesh.faces, area[:, None, None] / 12 * pattern, n)
    faces, l_sq = intrinsic_delaunay(metric.mesh)
    rho = metric.conformal_factor[faces]
    weight = rho.sum(axis=1)[:, None, None] + rho[:, :, None] + rho[:, None, :]  # 60 x integral of psi_k psi_l rho
    return _assembled(faces, intrinsic.areas(l_sq)[:, None, None] / 60 * weight * pattern, n)


def _assembled(faces: Integers, element: Floats, n: int) -> sp.csr_matrix:
    """Sum of element matrices (m, 3, 3) into a sparse matrix (n, n)."""
    i, j = np.repeat(faces, 3, axis=1), np.tile(faces, 3)
    return sp.coo_matrix((element.ravel(), (i.ravel(), j.ravel())), shape=(n, n)).tocsr()


__getattr__ = names_moved(__name__, ("geodesics.intrinsic", "geodesics.one_ring"))
