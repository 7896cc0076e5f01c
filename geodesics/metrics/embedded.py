"""The metric the surface inherits from space."""

from __future__ import annotations

import numpy as np

from geodesics.mesh import Mesh
from geodesics.metric import Metric, conformal


def embedded(mesh: Mesh) -> Metric:
    """The embedded metric g_ij = <S_i, S_j> (sec. 2)."""
    return conformal(mesh, np.ones(mesh.n_vertices))
