"""The other scale-invariant arc lengths of sec. 2; of these only sqrt|K| ds is also invariant to isometries."""

from __future__ import annotations

import numpy as np

from geodesics.curvature import gaussian_curvature, mean_curvature, principal_curvatures
from geodesics.mesh import Mesh
from geodesics.metric import Metric, conformal
from geodesics.metrics._regularised import regularised
from geodesics.smoothing import DEFAULT


def first_curvature_length(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = DEFAULT) -> Metric:
    """d tau = |k1| ds (sec. 2), k1 the larger signed principal curvature."""
    return conformal(mesh, regularised(mesh, principal_curvatures(mesh, smoothing)[0] ** 2, regularisation))


def second_curvature_length(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = DEFAULT) -> Metric:
    """d tau = |k2| ds (sec. 2), k2 the smaller signed principal curvature."""
    return conformal(mesh, regularised(mesh, principal_curvatures(mesh, smoothing)[1] ** 2, regularisation))


def curvature_ratio_length(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = DEFAULT) -> Metric:
    """d tau = |K / H| ds (sec. 2), that is 2 ds / |rho_1 + rho_2|; |K| is kept where H vanishes."""
    k, h = gaussian_curvature(mesh, smoothing), mean_curvature(mesh, smoothing)
    squared = k**2 / np.maximum(h**2, np.abs(k) / 4 + np.finfo(float).tiny)
    return conformal(mesh, regularised(mesh, squared, regularisation))


def gaussian_curvature_length(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = DEFAULT) -> Metric:
    """d tau = sqrt|K| ds (sec. 2): the arc length of the scale-invariant metric (2.1)."""
    return conformal(mesh, regularised(mesh, gaussian_curvature(mesh, smoothing), regularisation))
