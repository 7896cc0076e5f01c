"""The equi-affine metric."""

from __future__ import annotations

import numpy as np

from geodesics import intrinsic
from geodesics.arguments import real_number
from geodesics.arrays import Floats, Integers
from geodesics.curvature import vertex_normals
from geodesics.intrinsic import vertex_sums
from geodesics.mesh import Mesh, of_a_mesh
from geodesics.metric import Metric
from geodesics.topology.edges import edge_keys


@of_a_mesh
def equi_affine(mesh: Mesh, *, regularisation: float = 0.05) -> Metric:
    r"""The equi-affine metric (sec. 2), invariant to volume-preserving affine maps.

    .. math:: \tilde g_{ij} = |K|^{-1/4} \, b_{ij}

    with :math:`b_{ij}` the second fundamental form of each face, from the normals at its corners. It is projected to
    positive definite by the absolute values of the principal curvatures, so the invariance is that of convex surfaces;
    saddles keep it only approximately.

    Parameters
    ----------
    mesh : Mesh
        The surface.
    regularisation : float
        The least principal curvature, in units of 1 / radius of a sphere of the same area.

    Returns
    -------
    Metric
        Its squared lengths are in units of length^(3/2).

    References
    ----------
    Raviv, Bronstein, Bronstein, Kimmel, Sochen: Affine-invariant diffusion geometry for the analysis of deformable 3D
    shapes (2011).

    See Also
    --------
    affine : Invariant to all affine maps.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> geodesics.equi_affine(sphere).mass.shape
    (162,)
    """
    return metric_of_lengths(mesh, intrinsic.lengths_from_tensor(equi_affine_tensor(mesh, regularisation)))


def equi_affine_tensor(mesh: Mesh, regularisation: float = 0.05) -> Floats:
    """The tensor |K|^(-1/4) |b_ij| per face (m, 2, 2), in barycentric coordinates; units of length^(3/2)."""
    regularisation = real_number(regularisation, "regularisation", 0.0)
    v, faces = mesh.vertices, mesh.faces
    edge = np.stack([v[faces[:, 1]] - v[faces[:, 0]], v[faces[:, 2]] - v[faces[:, 0]]], axis=1)
    area = 0.5 * np.linalg.norm(np.cross(edge[:, 0], edge[:, 1]), axis=1)
    normal = vertex_normals(mesh)
    turn = np.stack([normal[faces[:, 1]] - normal[faces[:, 0]], normal[faces[:, 2]] - normal[faces[:, 0]]], axis=1)
    form = turn @ edge.transpose(0, 2, 1)
    form = 0.5 * (form + form.transpose(0, 2, 1))

    length = np.sqrt(area.sum() / (4 * np.pi))
    first = edge @ edge.transpose(0, 2, 1)
    first += 1e-12 * np.trace(first, axis1=1, axis2=2)[:, None, None] * np.eye(2)  # a sliver still has an inverse
    first += (1e-12 * length) ** 2 * np.eye(2)
    root = np.linalg.cholesky(first)
    inverse = np.linalg.inv(root)
    curvature, direction = np.linalg.eigh(inverse @ form @ inverse.transpose(0, 2, 1))
    curvature = np.maximum(np.abs(curvature), regularisation / length)
    frame = root @ direction
    positive = (frame * curvature[:, None, :]) @ frame.transpose(0, 2, 1)
    return positive * (curvature.prod(axis=1) ** -0.25)[:, None, None]


def metric_of_lengths(mesh: Mesh, l_sq: Floats) -> Metric:
    """The metric with these squared lengths (m, 3), made equal along the edges of neighbouring faces.

    Each edge takes the mean of its faces, which leaves the operator as it is and makes geodesics the same in both
    directions; faces that would lose their area by that keep their own. The mass is a third of the area around.
    """
    shared = shared_lengths(mesh.faces, l_sq, mesh.n_vertices)
    length = np.sort(np.sqrt(shared), axis=1)
    flat = length[:, 2] > 0.99 * (length[:, 0] + length[:, 1])
    l_sq = np.where(flat[:, None], l_sq, shared)
    return Metric(mesh, l_sq, vertex_sums(mesh.faces, intrinsic.areas(l_sq) / 3, mesh.n_vertices))


def shared_lengths(faces: Integers, l_sq: Floats, n: int) -> Floats:
    """Squared edge lengths (m, 3) on which neighbouring faces agree: from the mean length over the faces of each edge.

    Only then do angles add up round a vertex.
    """
    keys = edge_keys(faces[:, [1, 2, 0]], faces[:, [2, 0, 1]], n)
    edge = np.unique(keys, return_inverse=True)[1].ravel()
    mean = np.bincount(edge, np.sqrt(l_sq).ravel()) / np.bincount(edge)
    return (mean[edge] ** 2).reshape(-1, 3)
