"""Curvature of a triangle mesh at its vertices: the angle defect as it is, and smoothed so that remeshing keeps it."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from geodesics import intrinsic
from geodesics.arguments import real_number
from geodesics.arrays import Bools, Floats
from geodesics.caching import memoized
from geodesics.delaunay import IntrinsicTriangulation, intrinsic_delaunay
from geodesics.intrinsic import vertex_areas, vertex_sums
from geodesics.laplacian import cotangent_matrix
from geodesics.linalg.factors import factorised
from geodesics.mesh import Mesh, of_a_mesh
from geodesics.moved_paths import names_moved
from geodesics.smoothing import DEFAULT_SMOOTHING, FIRST_LOOK
from geodesics.topology.components import boundary_vertices
from geodesics.topology.edges import proper_faces
from geodesics.topology.orientation import orient_faces


@of_a_mesh
def angle_defect(mesh: Mesh) -> Floats:
    r"""The angle defect, the numerator of :math:`|K_i|` below (4.5).

    .. math:: 2 \pi - \sum_f \theta_f \quad \text{(on the boundary } \pi - \sum_f \theta_f \text{)}

    Over a closed surface it sums to :math:`2 \pi` times the Euler characteristic.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.

    Returns
    -------
    array of shape (n,)
        Radians; 0 at a vertex on no face.

    See Also
    --------
    gaussian_curvature : Per area, and smoothed.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> import numpy as np
    >>> defect = geodesics.angle_defect(sphere)
    >>> float((defect.sum() / np.pi).round(6))  # 4 pi in all (Gauss-Bonnet)
    4.0
    """
    faces = mesh.faces[proper_faces(mesh.faces)]
    theta = intrinsic.angles(intrinsic.squared_lengths(mesh.vertices, faces))
    flat = np.where(boundary_vertices(mesh), np.pi, 2 * np.pi)
    flat[np.bincount(faces.ravel(), minlength=mesh.n_vertices) == 0] = 0
    return flat - vertex_sums(faces, theta, mesh.n_vertices)


@of_a_mesh
def gaussian_curvature(mesh: Mesh, smoothing: float = DEFAULT_SMOOTHING) -> Floats:
    r"""Gaussian curvature: the angle defect per area, smoothed so that remeshing keeps it.

    One implicit heat step

    .. math:: (A - \nabla \cdot \tau \nabla) \, K = \mathrm{defect}

    whose time :math:`\tau` at each place is `smoothing` times the area :math:`4 \pi / |K|` of the sphere of the same
    curvature. A part that grows is smoothed as it was, so :math:`|K| \, dA` is invariant to local scale as well. The
    boundary has no curvature of its own and takes over that of its neighbourhood.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.
    smoothing : float
        Without unit, not negative; 4e-3 by default; 0 gives :math:`K_i` of (4.5) with vertex areas of the intrinsic
        Delaunay triangulation.

    Returns
    -------
    array of shape (n,)
        K in units of 1 / length^2.

    See Also
    --------
    angle_defect : Before smoothing.
    mean_curvature, principal_curvatures : The other curvatures, smoothed in the same way.
    scale_invariant : The metric made of it.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> float(geodesics.gaussian_curvature(sphere).mean().round(1))  # 1 / radius^2
    1.0
    """
    triangulation = intrinsic_delaunay(mesh)
    interior = ~boundary_vertices(mesh)
    defect = np.where(interior, angle_defect(mesh), 0.0)
    time = curvature_time(triangulation, defect, interior, smoothing)
    return smoothed_density(triangulation, defect, interior, time)


@of_a_mesh
def mean_curvature(mesh: Mesh, smoothing: float = DEFAULT_SMOOTHING) -> Floats:
    """Mean curvature, positive where a closed surface is convex.

    .. math:: W x = 2 A H n

    with x the positions, W the stiffness matrix, A the vertex areas and n the `vertex_normals`; smoothed as
    `gaussian_curvature` is.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.
    smoothing : float
        As of `gaussian_curvature`.

    Returns
    -------
    array of shape (n,)
        H in units of 1 / length.

    See Also
    --------
    principal_curvatures : With the Gaussian curvature they give the principal ones.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> float(abs(geodesics.mean_curvature(sphere)).mean().round(1))  # 1 / radius
    1.0
    """
    triangulation, n = intrinsic_delaunay(mesh), mesh.n_vertices
    laplacian = cotangent_matrix(triangulation, n) @ (mesh.vertices - mesh.vertices.mean(axis=0))
    interior = ~boundary_vertices(mesh)
    bend = np.where(interior, 0.5 * (laplacian * vertex_normals(mesh)).sum(axis=1), 0.0)
    time = curvature_time(triangulation, np.where(interior, angle_defect(mesh), 0.0), interior, smoothing)
    return smoothed_density(triangulation, bend, interior, time)


@of_a_mesh
def principal_curvatures(mesh: Mesh, smoothing: float = DEFAULT_SMOOTHING) -> tuple[Floats, Floats]:
    r"""Principal curvatures :math:`k_{1,2} = H \pm \sqrt{H^2 - K}`; where the radicand is negative it is taken as 0.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.
    smoothing : float
        As of `gaussian_curvature`.

    Returns
    -------
    k1, k2 : arrays of shape (n,)
        In units of 1 / length, k1 >= k2.

    See Also
    --------
    gaussian_curvature, mean_curvature : Their product and their mean.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> one, other = geodesics.principal_curvatures(sphere)
    >>> [float(abs(k).mean().round(1)) for k in (one, other)]
    [1.0, 1.0]
    """
    h = mean_curvature(mesh, smoothing)
    root = np.sqrt(np.maximum(h**2 - gaussian_curvature(mesh, smoothing), 0))
    return h + root, h - root


@of_a_mesh
@memoized
def vertex_normals(mesh: Mesh) -> Floats:
    """Unit normals of vertices: those of the faces around them, weighted by angle.

    Faces are oriented consistently first, outward where the surface is closed (see `orient_faces`).

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.

    Returns
    -------
    array of shape (n, 3)
        Unit vectors; 0 where there is no face.

    Examples
    --------
    >>> import geodesics
    >>> triangle = geodesics.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    >>> geodesics.vertex_normals(triangle).tolist()
    [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]
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

    That curvature is K smoothed with one time everywhere. At most `smoothing` times the area of the surface, where it
    is flat.
    """
    smoothing = real_number(smoothing, "smoothing", 0.0)
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
