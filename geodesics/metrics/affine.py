"""The affine-invariant metric."""

from __future__ import annotations

import numpy as np

from geodesics import intrinsic
from geodesics.curvature import curvature_time, smoothed_density
from geodesics.delaunay import IntrinsicTriangulation
from geodesics.intrinsic import vertex_sums
from geodesics.mesh import Mesh
from geodesics.metric import Metric
from geodesics.metrics.equi_affine import equi_affine_tensor, metric_of_lengths, shared_lengths
from geodesics.smoothing import EQUI_AFFINE
from geodesics.topology.components import boundary_vertices


def affine(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = EQUI_AFFINE) -> Metric:
    """The metric |K^eq| g^eq (sec. 2), K^eq the Gaussian curvature of the equi-affine metric g^eq.

    |K^eq| is regularised as |K| is below (2.1), with the equi-affine area. Invariant to affine maps as far as
    `equi_affine` is to volume-preserving ones. K^eq takes four derivatives of position, so it is smoothed more than K.
    """
    faces, n = mesh.faces, mesh.n_vertices
    l_sq = shared_lengths(faces, intrinsic.lengths_from_tensor(equi_affine_tensor(mesh)), n)
    interior = ~boundary_vertices(mesh)
    interior &= np.bincount(faces.ravel(), minlength=n) > 0
    defect = np.where(interior, 2 * np.pi - vertex_sums(faces, intrinsic.angles(l_sq), n), 0.0)
    triangulation = IntrinsicTriangulation(faces, l_sq)
    time = curvature_time(triangulation, defect, interior, smoothing)
    curvature = smoothed_density(triangulation, defect, interior, time)
    epsilon = regularisation * 4 * np.pi / intrinsic.areas(l_sq).sum()
    return metric_of_lengths(mesh, intrinsic.conformal_lengths(l_sq, faces, np.hypot(curvature, epsilon)))
