"""Operators on functions that a map should commute with, as matrices between eigenfunctions."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from gmds.surface.view import View


def multiplication(view: View, function: Floats, count: int) -> Floats:
    r"""Multiplication by a function (n,): :math:`\int f \phi_i \phi_j da` (count, count) (Nogneng, Ovsjanikov 2017)."""
    rows = view.functions[:, :count]
    return np.asarray(rows.T @ ((view.spectrum.mass * function)[:, None] * rows), dtype=np.float64)


def orientation_operator(view: View, function: Floats, count: int) -> Floats:
    r"""Which way around a function (n,) others grow: :math:`\int \phi_i \, n \cdot (\nabla f \times \nabla \phi_j) da`.

    It depends on no metric, as the 2-form :math:`df \wedge d\phi_j` is integrated, and changes its sign under a
    reflection (Ren, Poulenard, Wonka, Ovsjanikov 2018).
    """
    faces, rows = view.mesh.faces, view.functions[:, :count]
    corner, f = rows[faces], function[faces]
    first, second = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    wedge = 0.5 * ((f[:, 1] - f[:, 0])[:, None] * second - (f[:, 2] - f[:, 0])[:, None] * first)
    return np.asarray(corner.mean(axis=1).T @ wedge, dtype=np.float64)
