"""The epsilon of sec. 2, in proportion to 1 / area: metrics made with it are scale invariant."""

from __future__ import annotations

import numpy as np

from geodesics.arguments import real_number
from geodesics.arrays import Floats
from geodesics.delaunay import intrinsic_delaunay
from geodesics.intrinsic import vertex_areas
from geodesics.mesh import Mesh


def regularised(mesh: Mesh, curvature: Floats, regularisation: float) -> Floats:
    """The factor sqrt(K^2 + eps^2) (n,) below (2.1), eps = regularisation * 4 pi / area: that of a sphere of the same
    area.
    """
    regularisation = real_number(regularisation, "regularisation", 0.0)
    area = vertex_areas(*intrinsic_delaunay(mesh), mesh.n_vertices).sum()
    return np.hypot(curvature, regularisation * 4 * np.pi / area)
