"""The affine-invariant metric."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics import intrinsic
from geodesics.curvature import SMOOTHING, curvature_time, smoothed_density
from geodesics.delaunay import IntrinsicTriangulation
from geodesics.laplacian import vertex_sums
from geodesics.mesh import Mesh
from geodesics.metric import Metric
from geodesics.metrics.equi_affine import equi_affine_tensor, metric_of_tensor
from geodesics.topology import boundary_vertices

Array = NDArray[np.float64]


def affine(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = SMOOTHING) -> Metric:
    """The metric |K^eq| g^eq (sec. 2), K^eq the Gaussian curvature of the equi-affine metric g^eq.

    |K^eq| is regularised as |K| is below (2.1), with the equi-affine area. Invariant to affine maps as far as
    `equi_affine` is to volume-preserving ones.
    """
    tensor = equi_affine_tensor(mesh)
    faces, n = mesh.faces, mesh.n_vertices
    l_sq = shared_lengths(faces, intrinsic.lengths_from_tensor(tensor), n)
    interior = ~boundary_vertices(mesh)
    interior &= np.bincount(faces.ravel(), minlength=n) > 0
    defect = np.where(interior, 2 * np.pi - vertex_sums(faces, intrinsic.angles(l_sq), n), 0.0)
    triangulation = IntrinsicTriangulation(faces, l_sq)
    time = curvature_time(triangulation, defect, interior, smoothing)
    curvature = smoothed_density(triangulation, defect, interior, time)
    epsilon = regularisation * 4 * np.pi / intrinsic.areas(l_sq).sum()
    factor = np.hypot(curvature, epsilon)[faces].mean(axis=1)
    return metric_of_tensor(mesh, tensor * factor[:, None, None])


def shared_lengths(faces: NDArray[np.int64], l_sq: Array, n: int) -> Array:
    """Squared edge lengths (m, 3) on which neighbouring faces agree: the mean over the faces of each edge.

    Angles add up round a vertex only then.
    """
    i, j = faces[:, [1, 2, 0]], faces[:, [2, 0, 1]]
    edge = np.unique((np.minimum(i, j) * n + np.maximum(i, j)).ravel(), return_inverse=True)[1].ravel()
    mean = np.bincount(edge, np.sqrt(l_sq).ravel()) / np.bincount(edge)
    return (mean[edge] ** 2).reshape(-1, 3)
