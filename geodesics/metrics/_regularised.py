"""The epsilon of sec. 2, tied to the surface so that every metric built from it is scale invariant."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics.delaunay import intrinsic_delaunay
from geodesics.laplacian import vertex_areas
from geodesics.mesh import Mesh

Array = NDArray[np.float64]


def regularised(mesh: Mesh, curvature: Array, regularisation: float) -> Array:
    """sqrt(K^2 + eps^2) (n,), below (2.1), eps = regularisation * 4 pi / area: that of a sphere of the same area."""
    area = vertex_areas(intrinsic_delaunay(mesh), mesh.n_vertices).sum()
    return np.hypot(curvature, regularisation * 4 * np.pi / area)
