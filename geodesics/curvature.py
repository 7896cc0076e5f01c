"""Curvature of a triangle mesh."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geodesics import intrinsic
from geodesics.delaunay import intrinsic_delaunay
from geodesics.mesh import Mesh
from geodesics.topology import boundary_vertices

Array = NDArray[np.float64]


def angle_defect(mesh: Mesh) -> Array:
    """2 pi (pi on the boundary) minus the angles around each vertex, shape (n,)."""
    total = np.zeros(mesh.n_vertices)
    theta = intrinsic.angles(intrinsic.squared_lengths(mesh.vertices, mesh.faces))
    np.add.at(total, mesh.faces, theta)
    flat = np.where(boundary_vertices(mesh), np.pi, 2 * np.pi)
    flat[np.bincount(mesh.faces.ravel(), minlength=mesh.n_vertices) == 0] = 0
    return flat - total


def gaussian_curvature(mesh: Mesh, smoothing: float = 3e-4) -> Array:
    """Angle defect smoothed by one implicit heat step, (A + tau W) K = defect, tau = smoothing * area; shape (n,)."""
    from geodesics.laplacian import cotangent_matrix, vertex_areas

    defect = np.where(boundary_vertices(mesh), 0.0, angle_defect(mesh))
    triangulation = intrinsic_delaunay(mesh)
    mass = vertex_areas(triangulation, mesh.n_vertices)
    system = sp.diags(mass) + smoothing * mass.sum() * cotangent_matrix(triangulation, mesh.n_vertices)
    return sp.linalg.spsolve(system.tocsc(), defect)
