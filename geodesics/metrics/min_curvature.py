"""The metric of the smaller principal curvature."""

from __future__ import annotations

import numpy as np

from geodesics.curvature import principal_curvatures
from geodesics.mesh import Mesh
from geodesics.metric import Metric, conformal
from geodesics.metrics._regularised import regularised
from geodesics.smoothing import DEFAULT


def min_curvature(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = DEFAULT) -> Metric:
    """The metric kappa_min^2 g of (7.1), kappa_min^2 = (sqrt(H^2 - K) - |H|)^2, regularised as |K| is below (2.1).

    Scale invariant, but bending changes it. The paper names it and leaves it unexplored.
    """
    first, second = principal_curvatures(mesh, smoothing)
    smaller = np.minimum(np.abs(first), np.abs(second))
    return conformal(mesh, regularised(mesh, smaller**2, regularisation))
