"""Curvature of a triangle mesh at its vertices: to the letter of the paper, and smoothed so that remeshing keeps it."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from geodesics import intrinsic
from geodesics.arrays import Bools, Floats
from geodesics.caching import memoized
from geodesics.delaunay import IntrinsicTriangulation, intrinsic_delaunay
from geodesics.intrinsic import vertex_areas, vertex_sums
from geodesics.laplacian import cotangent_matrix
from geodesics.linalg.factors import factorised
from geodesics.mesh import Mesh
from geodesics.moved_paths import names_moved
from geodesics.smoothing import DEFAULT, FIRST_LOOK
from geodesics.topology.components import boundary_vertices
from geodesics.topology.edges import proper_faces
from geodesics.topology.orientation import orient_faces


def angle_defect(mesh: Mesh) -> Floats:
    """2 pi (pi on the boundary) minus the angles around each vertex, shape (n,), radians; 0 where there is no face.

    The numerator of |K_i| below (4.5). Over a closed surface it sums to 2 pi times the Euler characteristic.
    """
    faces = mesh.faces[proper_faces(mesh.faces)]
    theta = intrinsic.angles(intrinsic.squared_lengths(mesh.vertices, faces))
    flat = np.where(boundary_vertices(mesh), np.pi, 2 * np.pi)
    flat[np.bincount(faces.ravel(), minlength=mesh.n_vertices) == 0] = 0
    return flat - vertex_sums(faces, theta, mesh.n_vertices)


def gaussian_curvature(mesh: Mesh, smoothing: float = DEFAULT) -> Floats:
    """Gaussian curvature K (n,) in units of 1 / length^2: the angle defect, smoothed so that remeshing keeps it.

    One implicit heat step (A + div(tau grad)) K = defect whose time tau at each place is `smoothing` times the area of
    the sphere of the same curvature: a part that grows is smoothed as it was, so |K| dA is invariant to local scale as
    well. The boundary has no curvature of its own and takes over that of its neighbourhood. `smoothing` 0 gives K_i of
    (4.5) with vertex areas of the intrinsic Delaunay triangulation.
    """
    triangulation = intrinsic_delaunay(mesh)
    interior = ~boundary_vertices(mesh)
    defect = np.where(interior, angle_defect(mesh), 0.0)
    time = curvature_time(triangulation, defect, interior, smoothing)
    return smoothed_density(triangulation, defect, interior, time)


def mean_curvature(mesh: Mesh, smoothing: float = DEFAULT) -> Floats:
    """Mean curvature H (n,) in units of 1 / length, positive where a closed surface is convex.

    2 H n is the Laplacian of position (W x = 2 A H n), n the normals of `vertex_normals`; smoothed as
    `gaussian_curvature`.
    """
    triangulation, n = intrinsic_delaunay(mesh), mesh.n_vertices
    laplacian = cotangent_matrix(triangulation, n) @ (mesh.vertices - mesh.vertices.mean(axis=0))
    interior = ~boundary_vertices(mesh)
    bend = np.where(interior, 0.5 * (laplacian * vertex_normals(mesh)).sum(axis=1), 0.0)
    time = curvature_time(triangulation, np.where(interior, angle_defect(mesh), 0.0), interior, smoothing)
    return smoothed_density(triangulation, bend, interior, time)


def principal_curvatures(mesh: Mesh, smoothing: float = DEFAULT) -> tuple[Floats, Floats]:
    """Principal curvatures k1 >= k2, each (n,) in units of 1 / length: H +- sqrt(H^2 - K), the root cut off at 0."""
    h = mean_curvature(mesh, smoothing)
    root = np.sqrt(np.maximum(h**2 - gaussian_curvature(mesh, smoothing), 0))
    return h + root, h - root


@memoized
def vertex_normals(mesh: Mesh) -> Floats:
    """Unit normals (n, 3), the normals of the faces around each vertex weighted by angle; 0 where there are none.

    Faces are oriented consistently first, outward where the surface is closed (`orient_faces`).
    """
    a, b, c = (mesh.vertices[corner] for corner in orient_faces(mesh).faces.T)
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(float).tiny)
    theta = intrinsic.angles(intrinsic.squared_lengths(mesh.vertices, mesh.faces))
    total = np.stack([vertex_sums(mesh.faces, theta * normal[:, [k]], mesh.n_vertices) for k in range(3)], axis=1)
    size = np.linalg.norm(total, axis=1, keepdims=True)
    return total / np.where(size > 0, size, 1)


def curvature_time(triangulation: IntrinsicTriangulation, defect: Floats, interior: Bools, smoothing: float) -> Floats:
    """`smoothing` times the area 4 pi / |K| of the sphere of the same curvature, per face (m,).

    That curvature is a coarse look at K. At most `smoothing` times the area of the surface, where it is flat.
    """
    area = intrinsic.areas(triangulation.l_sq).sum()
    coarse = smoothed_density(triangulation, defect, interior, np.full(len(triangulation.faces), FIRST_LOOK * area))
    curvature = np.hypot(coarse, 4 * np.pi / area)[triangulation.faces].mean(axis=1)
    return smoothing * 4 * np.pi / curvature


def smoothed_density(triangulation: IntrinsicTriangulation, amounts: Floats, interior: Bools, time: Floats) -> Floats:
    """Density (n,) of amounts per vertex (n,) after one implicit heat step of time (m,) per face, in units of area.

    Where `interior` is False nothing was measured, and the value comes from the neighbours alone.
    """
    n = len(amounts)
    area = vertex_areas(*triangulation, n)
    used = np.flatnonzero(area > 0)
    weight = np.where(interior, area, 1e-9 * area)[used]  # a little, or a part that is all boundary is singular
    diffusion = cotangent_matrix(triangulation, n, time)[used][:, used]
    density = np.zeros(n)
    density[used] = factorised(sp.diags(weight) + diffusion).solve(amounts[used])
    return density


__getattr__ = names_moved(__name__, ("geodesics.one_ring",))
