"""Areas, curvature and operator of one-rings, exactly as in (4.5)."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from geodesics import intrinsic
from geodesics.arrays import Floats
from geodesics.curvature import angle_defect
from geodesics.delaunay import IntrinsicTriangulation
from geodesics.intrinsic import vertex_sums
from geodesics.laplacian import cotangent_matrix
from geodesics.mesh import Mesh
from geodesics.topology.components import boundary_vertices
from geodesics.topology.edges import proper_faces


def one_ring_areas(mesh: Mesh) -> Floats:
    """:math:`A_{ii}` of (4.5): the area of all faces that contain the vertex.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.

    Returns
    -------
    array of shape (n,)
        Areas in units of length^2.
    """
    faces = mesh.faces[proper_faces(mesh.faces)]
    return vertex_sums(faces, intrinsic.areas(intrinsic.squared_lengths(mesh.vertices, faces)), mesh.n_vertices)


def one_ring_curvature(mesh: Mesh) -> Floats:
    r"""The curvature below (4.5), exactly as written and signed.

    .. math:: K_i = \frac{3 (2 \pi - \sum_f \theta_f)}{A_{ii}}

    It is dominated by the noise of the mesh: prefer `gaussian_curvature`.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.

    Returns
    -------
    array of shape (n,)
        Units of 1 / length^2; 0 on the boundary and at vertices without area.
    """
    defect = np.where(boundary_vertices(mesh), 0.0, angle_defect(mesh))
    area = one_ring_areas(mesh)
    return np.divide(3 * defect, area, out=np.zeros_like(area), where=area > 0)


def cotangent_operator(mesh: Mesh, epsilon: float) -> sp.csr_matrix:
    r"""The operator :math:`L = K^{-1} A^{-1} W` of (4.5), exactly as written.

    :math:`A_{ii}` is the area of the whole one-ring, W has :math:`\cot \alpha + \cot \beta` without the half, and

    .. math:: |K_i| = \sqrt{(3 \, \mathrm{defect}_i / A_{ii})^2 + \epsilon}

    So L is 2/3 of the consistent operator, is not symmetric, and changes with the unit of length through
    :math:`\epsilon`. For eigenpairs use ``eigenpairs(scale_invariant(mesh), count)``.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.
    epsilon : float
        In units of 1 / length^4.

    Returns
    -------
    sparse matrix of shape (n, n)
        Zero rows at vertices on no face.
    """
    w = 2 * cotangent_matrix(IntrinsicTriangulation(mesh.faces, _embedded_lengths(mesh)), mesh.n_vertices)
    weight = one_ring_areas(mesh) * np.sqrt(one_ring_curvature(mesh) ** 2 + epsilon)
    return (sp.diags(np.divide(1, weight, out=np.zeros_like(weight), where=weight > 0)) @ w).tocsr()


def _embedded_lengths(mesh: Mesh) -> Floats:
    return intrinsic.squared_lengths(mesh.vertices, mesh.faces)
