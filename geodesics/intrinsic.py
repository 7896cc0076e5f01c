"""Triangle formulas that need only squared edge lengths (m, 3); edge k is opposite corner k.

Three lengths and a metric tensor say the same thing: in the coordinates (u, v) of a face, its barycentric weights of
corners 1 and 2, the tensor g_ij = <S_i, S_j> of sec. 2 is constant and S_1, S_2 are the edges from corner 0.
"""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats, Integers

_SLIVER = 1e-8  # triangles are taken to be at least this times as high as long: bounds every cotangent by 1 / _SLIVER


def squared_lengths(vertices: Floats, faces: Integers) -> Floats:
    """Squared edge lengths (m, 3); column k is the edge opposite corner k."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.stack([((b - c) ** 2).sum(1), ((c - a) ** 2).sum(1), ((a - b) ** 2).sum(1)], axis=1)


def areas(l_sq: Floats) -> Floats:
    """Triangle areas (m,) by Heron's formula in Kahan's stable ordering."""
    a, b, c = np.sort(np.sqrt(l_sq), axis=1).T[::-1]
    product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))
    return 0.25 * np.sqrt(np.maximum(product, 0))


def cotangents(l_sq: Floats) -> Floats:
    """Cotangents (m, 3) of the corner angles: cot_k = (sum of the other two - l_k^2) / (4 area); finite on slivers."""
    area = _areas_of_slivers(l_sq)
    return (l_sq.sum(1, keepdims=True) - 2 * l_sq) / (4 * np.where(area > 0, area, 1))[:, None]


def angles(l_sq: Floats) -> Floats:
    """Corner angles (m, 3) in radians; those of a sliver add up to pi as well."""
    opposite_sum = l_sq.sum(1, keepdims=True) - 2 * l_sq
    return np.arctan2(4 * _areas_of_slivers(l_sq)[:, None], opposite_sum)


def _areas_of_slivers(l_sq: Floats) -> Floats:
    return np.maximum(areas(l_sq), 0.5 * _SLIVER * l_sq.max(axis=1))


def tensor_from_lengths(l_sq: Floats) -> Floats:
    """The metric tensor g_ij (m, 2, 2) whose triangle has these squared edge lengths (m, 3)."""
    g12 = 0.5 * (l_sq[:, 1] + l_sq[:, 2] - l_sq[:, 0])
    return np.stack([l_sq[:, 2], g12, g12, l_sq[:, 1]], axis=1).reshape(-1, 2, 2)


def lengths_from_tensor(tensor: Floats) -> Floats:
    """Squared edge lengths (m, 3) of the triangles with this metric tensor (m, 2, 2)."""
    g11, g12, g22 = tensor[:, 0, 0], tensor[:, 0, 1], tensor[:, 1, 1]
    return np.stack([g11 - 2 * g12 + g22, g22, g11], axis=1)


def conformal_lengths(l_sq: Floats, faces: Integers, factor: Floats) -> Floats:
    """Squared edge lengths (m, 3) in rho * g, rho (n,) per vertex: one slowness a face, so triangles stay triangles."""
    return l_sq * np.sqrt(factor)[faces].mean(axis=1, keepdims=True) ** 2


def vertex_areas(faces: Integers, l_sq: Floats, n: int) -> Floats:
    """A third of the area of the faces around each vertex, shape (n,)."""
    return vertex_sums(faces, areas(l_sq) / 3, n)


def vertex_sums(faces: Integers, values: Floats, n: int) -> Floats:
    """Sum over the faces around each vertex, shape (n,), of values per face (m,) or per corner (m, 3)."""
    corners = np.broadcast_to(values[:, None] if values.ndim == 1 else values, faces.shape)
    return np.bincount(faces.ravel(), corners.ravel(), minlength=n).astype(np.float64)
