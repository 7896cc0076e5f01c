r"""Triangle formulas that need only squared edge lengths (m, 3); edge k is opposite corner k.

Three lengths and a metric tensor hold the same information: in the coordinates (u, v) of a face, its barycentric
weights of corners 1 and 2, the tensor :math:`g_{ij} = \langle S_i, S_j \rangle` of sec. 2 is constant and
:math:`S_1, S_2` are the edges from corner 0.
"""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats, Integers

# Height over length of a triangle in `cotangents` and `angles`, at the least: bounds cotangents by its inverse. It is
# the root of the rounding error, below which squared lengths cannot distinguish a triangle from a segment.
_SLIVER = 1e-8


def squared_lengths(vertices: Floats, faces: Integers) -> Floats:
    """Squared lengths of the edges in space.

    Parameters
    ----------
    vertices : array of shape (n, 3)
        Positions.
    faces : int array of shape (m, 3)
        Triangles.

    Returns
    -------
    array of shape (m, 3)
        Column k is the edge opposite corner k.
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.stack([((b - c) ** 2).sum(1), ((c - a) ** 2).sum(1), ((a - b) ** 2).sum(1)], axis=1)


def areas(l_sq: Floats) -> Floats:
    r"""Areas of triangles by Heron's formula, in Kahan's order of operations, which is exact to rounding on needles.

    .. math:: A = \tfrac14 \sqrt{(a + (b + c)) (c - (a - b)) (c + (a - b)) (a + (b - c))}, \quad a \ge b \ge c

    Parameters
    ----------
    l_sq : array of shape (m, 3)
        Squared edge lengths.

    Returns
    -------
    array of shape (m,)
        Areas; 0 where the lengths break the triangle inequality.
    """
    a, b, c = np.sort(np.sqrt(l_sq), axis=1).T[::-1]
    product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))
    return 0.25 * np.sqrt(np.maximum(product, 0))


def cotangents(l_sq: Floats) -> Floats:
    r"""Cotangents of the corner angles.

    .. math:: \cot \theta_k = \frac{l_i^2 + l_j^2 - l_k^2}{4 A}

    Parameters
    ----------
    l_sq : array of shape (m, 3)
        Squared edge lengths.

    Returns
    -------
    array of shape (m, 3)
        Column k belongs to corner k. Slivers are taken to be at least 1e-8 times as high as long, so that all are
        finite.
    """
    area = _areas_of_slivers(l_sq)
    return (l_sq.sum(1, keepdims=True) - 2 * l_sq) / (4 * np.where(area > 0, area, 1))[:, None]


def angles(l_sq: Floats) -> Floats:
    """Corner angles.

    Parameters
    ----------
    l_sq : array of shape (m, 3)
        Squared edge lengths.

    Returns
    -------
    array of shape (m, 3)
        Angles in radians; column k belongs to corner k. Those of a sliver add up to pi as well.
    """
    opposite_sum = l_sq.sum(1, keepdims=True) - 2 * l_sq
    return np.arctan2(4 * _areas_of_slivers(l_sq)[:, None], opposite_sum)


def _areas_of_slivers(l_sq: Floats) -> Floats:
    return np.maximum(areas(l_sq), 0.5 * _SLIVER * l_sq.max(axis=1))


def tensor_from_lengths(l_sq: Floats) -> Floats:
    r"""The metric tensor whose triangles have these edge lengths (sec. 2), see `lengths_from_tensor`.

    .. math:: g_{11} = l_2^2, \quad g_{22} = l_1^2, \quad g_{12} = \tfrac12 (l_1^2 + l_2^2 - l_0^2)

    Parameters
    ----------
    l_sq : array of shape (m, 3)
        Squared edge lengths.

    Returns
    -------
    array of shape (m, 2, 2)
        :math:`g_{ij}` per face, in the barycentric coordinates of corners 1 and 2.
    """
    g12 = 0.5 * (l_sq[:, 1] + l_sq[:, 2] - l_sq[:, 0])
    return np.stack([l_sq[:, 2], g12, g12, l_sq[:, 1]], axis=1).reshape(-1, 2, 2)


def lengths_from_tensor(tensor: Floats) -> Floats:
    r"""Edge lengths of the triangles with this metric tensor (sec. 2), see `tensor_from_lengths`.

    .. math:: l_0^2 = g_{11} - 2 g_{12} + g_{22}, \quad l_1^2 = g_{22}, \quad l_2^2 = g_{11}

    Parameters
    ----------
    tensor : array of shape (m, 2, 2)
        :math:`g_{ij}` per face, in the barycentric coordinates of corners 1 and 2.

    Returns
    -------
    array of shape (m, 3)
        Squared edge lengths.
    """
    g11, g12, g22 = tensor[:, 0, 0], tensor[:, 0, 1], tensor[:, 1, 1]
    return np.stack([g11 - 2 * g12 + g22, g22, g11], axis=1)


def conformal_lengths(l_sq: Floats, faces: Integers, factor: Floats) -> Floats:
    r"""Edge lengths in the metric :math:`\rho g`: one scale per face, so that triangles stay triangles.

    .. math:: \tilde l^2 = l^2 \Big( \tfrac13 \sum_{k} \sqrt{\rho_k} \Big)^2

    Parameters
    ----------
    l_sq : array of shape (m, 3)
        Squared edge lengths in g.
    faces : int array of shape (m, 3)
        Triangles.
    factor : array of shape (n,)
        The positive factor :math:`\rho` at each vertex.

    Returns
    -------
    array of shape (m, 3)
        Squared edge lengths.
    """
    return l_sq * np.sqrt(factor)[faces].mean(axis=1, keepdims=True) ** 2


def vertex_areas(faces: Integers, l_sq: Floats, n: int) -> Floats:
    """A third of the area of the faces around each vertex.

    Parameters
    ----------
    faces : int array of shape (m, 3)
        Triangles.
    l_sq : array of shape (m, 3)
        Squared edge lengths.
    n : int
        Number of vertices.

    Returns
    -------
    array of shape (n,)
        Areas, which add up to that of the surface.
    """
    return vertex_sums(faces, areas(l_sq) / 3, n)


def vertex_sums(faces: Integers, values: Floats, n: int) -> Floats:
    """Sum over the faces around each vertex.

    Parameters
    ----------
    faces : int array of shape (m, 3)
        Triangles.
    values : array of shape (m,) or (m, 3)
        Values per face, or per corner.
    n : int
        Number of vertices.

    Returns
    -------
    array of shape (n,)
        Sums, 0 at a vertex on no face.
    """
    corners = np.broadcast_to(values[:, None] if values.ndim == 1 else values, faces.shape)
    return np.bincount(faces.ravel(), corners.ravel(), minlength=n).astype(np.float64)
