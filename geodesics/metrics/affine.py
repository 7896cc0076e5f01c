"""The affine-invariant metric."""

from __future__ import annotations

import numpy as np

from geodesics import intrinsic
from geodesics.arguments import real_number
from geodesics.curvature import curvature_time, smoothed_density
from geodesics.delaunay import IntrinsicTriangulation
from geodesics.intrinsic import vertex_sums
from geodesics.mesh import Mesh, of_a_mesh
from geodesics.metric import Metric
from geodesics.metrics.equi_affine import equi_affine_tensor, metric_of_lengths, shared_lengths
from geodesics.smoothing import EQUI_AFFINE
from geodesics.topology.components import boundary_vertices


@of_a_mesh
def affine(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = EQUI_AFFINE) -> Metric:
    r"""The affine-invariant metric (sec. 2).

    .. math:: \tilde g_{ij} = |K^{eq}| \, g^{eq}_{ij}

    with :math:`K^{eq}` the Gaussian curvature of the equi-affine metric :math:`g^{eq}`. It is invariant to affine maps
    as far as `equi_affine` is to volume-preserving ones. :math:`K^{eq}` takes four derivatives of position, so it is
    smoothed more than K.

    Parameters
    ----------
    mesh : Mesh
        The surface.
    regularisation : float
        eps of the regularisation below (2.1), in units of 4 pi / area: the curvature of a sphere of the same area, in
        the equi-affine metric.
    smoothing : float
        As of `gaussian_curvature`, without unit.

    Returns
    -------
    Metric
        Its lengths have no unit.

    See Also
    --------
    equi_affine : The metric that is rescaled.
    scale_invariant : The same with the metric of space.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> geodesics.affine(sphere).l_sq.shape
    (320, 3)
    """
    faces, n = mesh.faces, mesh.n_vertices
    l_sq = shared_lengths(faces, intrinsic.lengths_from_tensor(equi_affine_tensor(mesh)), n)
    interior = ~boundary_vertices(mesh)
    interior &= np.bincount(faces.ravel(), minlength=n) > 0
    defect = np.where(interior, 2 * np.pi - vertex_sums(faces, intrinsic.angles(l_sq), n), 0.0)
    triangulation = IntrinsicTriangulation(faces, l_sq)
    time = curvature_time(triangulation, defect, interior, smoothing)
    curvature = smoothed_density(triangulation, defect, interior, time)
    epsilon = real_number(regularisation, "regularisation", 0.0) * 4 * np.pi / intrinsic.areas(l_sq).sum()
    return metric_of_lengths(mesh, intrinsic.conformal_lengths(l_sq, faces, np.hypot(curvature, epsilon)))
